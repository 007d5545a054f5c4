import type { ExperimenterClient } from '../../client/study-client';
import { checkedPlan, participantsOf, type StudyPlan } from '../../model/plan/plan';
import {
  type CopyPurpose,
  rejectUnknownEffects,
  type StatedEffects,
  simulatedParticipants,
  simulatedPlan,
} from '../../simulation/simulate-study';

/** The parameters of a simulation: the same seed and effects give the same answers. */
export interface Simulation {
  readonly seed: number;
  readonly effects: StatedEffects;
}

export interface StoredSimulationOptions extends Simulation {
  /** The time at which the last participant finishes, in seconds since 1970. */
  readonly at: number;
  /** Called with the number of participants that are done and of all. */
  readonly onProgress?: (done: number, all: number) => void;
}

const secondsPerParticipant = 7200;

type SimulatingClient = Pick<ExperimenterClient, 'studies' | 'addStudy' | 'addSimulated' | 'deleteSimulated'>;

/** Adds a simulated copy of a study in place of an earlier one of this purpose; resolves with its plan. */
export async function addCopy(
  client: Omit<SimulatingClient, 'addSimulated'>,
  plan: StudyPlan,
  purpose: CopyPurpose,
): Promise<StudyPlan> {
  const simulated = checkedPlan(simulatedPlan(plan, purpose));
  if ((await client.studies()).some(({ id }) => id === simulated.id)) await client.deleteSimulated(simulated.id);
  await client.addStudy(simulated, true);
  return simulated;
}

/**
 * Stores simulated participants, who go through a plan to its end, in a separate study, which replaces that of an
 * earlier simulation. Resolves with the id of that study.
 */
export async function storeSimulation(
  client: SimulatingClient,
  plan: StudyPlan,
  { seed, effects, at, onProgress = () => undefined }: StoredSimulationOptions,
): Promise<string> {
  rejectUnknownEffects(plan, effects);
  const simulated = await addCopy(client, plan, 'simulated');
  const all = participantsOf(simulated).length;
  let done = 0;
  for (const one of simulatedParticipants(simulated, effects, seed, at - all * secondsPerParticipant)) {
    await client.addSimulated(simulated.id, one);
    done += 1;
    onProgress(done, all);
  }
  return simulated.id;
}
