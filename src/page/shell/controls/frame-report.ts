import type { FrameReport } from 'threepoint-ui/overlay';
import { estimatorTexts } from '../estimator-texts';
import { stageNames } from '../frame-timing';
import type { ControlledParts } from './controlled-parts';

/** What frames cost over the last seconds, and what estimates the body in them. */
export function frameReport({
  timing,
  body,
  difference,
}: Pick<ControlledParts, 'timing' | 'body' | 'difference'>): FrameReport {
  const summary = timing.summary();
  return {
    ...summary,
    stages: stageNames.map((name) => ({ name, ...summary.stages[name] })),
    estimator: estimatorTexts[body.estimator].label,
    provider: body.provider ?? 'no network',
    fromDevice: difference.report(),
  };
}
