import type { BodySolver } from 'threepoint';
import type { TrackingDegradation } from 'threepoint/core';
import { type Embodiment, PhrasedError } from 'threepoint-study';
import type { SettingsWriter } from '../settings';
import type { UserAvatar } from '../user-avatar';

/** The parts of the page that a study's condition changes. */
export interface EmbodyingParts {
  readonly writer: Pick<SettingsWriter, 'change'>;
  readonly avatar: Pick<UserAvatar, 'openBuiltIn' | 'builtInBody'>;
  readonly body: Pick<BodySolver, 'setEstimator' | 'estimator'>;
  readonly degradation: TrackingDegradation;
}

/**
 * Gives the participant the body of a round for this visit; resolves when it is drawn. Rejects with a sentence if it
 * cannot be drawn. Settings that the embodiment lacks are unchanged, and a degradation that it lacks is switched off.
 * `seed`: of the random parts of the degradation.
 */
export async function embody(parts: EmbodyingParts, embodiment: Embodiment, seed: number): Promise<void> {
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
