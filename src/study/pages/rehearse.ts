import type { ExperimenterClient } from '../client/study-client';
import { checkedPlan, participantsOf, type StudyPlan } from '../model/plan/plan';
import { modelsWith, rehearsalPlan, type StatedEffects, simulatedParticipants } from '../simulation/simulate-study';

/** How a study is rehearsed: the same seed and effects bring the same answers. */
export interface Rehearsal {
  readonly seed: number;
  readonly effects: StatedEffects;
}

export interface RehearsalOptions extends Rehearsal {
  /** Seconds since 1970: when the last participant was there. */
  readonly at: number;
  /** Hears how many participants are through, of how many. */
  readonly onProgress?: (done: number, all: number) => void;
}

const secondsPerParticipant = 7200;

/**
 * Sends simulated participants through a plan to its end, into a study of their own, which takes the place of an earlier rehearsal.
 * Returns the id of that study.
 */
export async function rehearse(
  client: Pick<ExperimenterClient, 'studies' | 'addStudy' | 'addSimulated' | 'deleteSimulated'>,
  plan: StudyPlan,
  { seed, effects, at, onProgress = () => undefined }: RehearsalOptions,
): Promise<string> {
  const rehearsed = checkedPlan(rehearsalPlan(plan));
  const models = modelsWith(rehearsed, effects);
  if ((await client.studies()).some(({ id }) => id === rehearsed.id)) await client.deleteSimulated(rehearsed.id);
  await client.addStudy(rehearsed, true);
  const all = participantsOf(rehearsed).length;
  let done = 0;
  for (const one of simulatedParticipants(rehearsed, models, seed, at - all * secondsPerParticipant)) {
    await client.addSimulated(rehearsed.id, one);
    done += 1;
    onProgress(done, all);
  }
  return rehearsed.id;
}
