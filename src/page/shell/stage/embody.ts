import { type Embodiment, PhrasedError } from 'threepoint-study';
import type { StageParts } from './stage-parts';

/**
 * Gives the participant the body of a round for this visit; resolves when it is drawn. Rejects with a sentence if it
 * cannot be drawn. Settings that the embodiment lacks are unchanged, and a degradation that it lacks is switched off.
 * `seed`: of the random parts of the degradation.
 */
export async function embody(parts: StageParts, embodiment: Embodiment, seed: number): Promise<void> {
  const { writer, avatar, body, degradation } = parts;
  const { estimator, avatar: builtInBody, mirror, upperBodyOnly, ...degradationSettings } = embodiment;
  writer.change({
    ...(mirror !== undefined && { mirror }),
    ...(upperBodyOnly !== undefined && { upperBodyOnly }),
    ...(builtInBody !== undefined && { builtInBody }),
  });
  degradation.configure(degradationSettings, seed);
  const wears = builtInBody === undefined || builtInBody === avatar.builtInBody || avatar.openBuiltIn();
  const [worn] = await Promise.all([wears, body.setEstimator(estimator)]);
  if (!worn || body.estimator !== estimator) throw new PhrasedError('round.body');
}
