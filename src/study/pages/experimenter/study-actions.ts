import { formatSentence } from 'threepoint-ui';
import type { ExperimenterClient } from '../../client/study-client';
import { checkedPlan, type StudyPlan } from '../../model/plan/plan';
import { Refusal } from '../../model/progress/refusal';
import type { StudyInfo } from '../../model/progress/study-api';
import { effectsInWords, simulatedPlan } from '../../simulation/simulate-study';
import { listStudies } from '../experimenter-access';
import { attempt, notice, openStudy, study } from './experimenter-state';
import { askForSimulation } from './simulation-dialog';
import { storeSimulation } from './store-simulation';

/** A new study: `name` is for messages, `json` reads its file. */
interface NewStudy {
  readonly name: string;
  readonly simulated: boolean;
  json(): Promise<string>;
}

/** Adds a study and opens it. */
export const addStudy = ({ name, simulated, json }: NewStudy) =>
  attempt(async (server) => {
    const plan = checkedPlan(JSON.parse(await json()));
    const added = simulated ? simulatedPlan(plan) : plan;
    const info = await addOrChange(server, added, simulated);
    if (!info) return `Nothing was changed: the study “${added.id}” keeps its plan.`;
    await listStudies(server);
    await openStudy(added.id);
    return `${name} is on this server${info.versions.length > 1 ? `, as version ${info.version} of the plan` : ''}.`;
  });

/**
 * Adds a study. If one of the same id has begun with another plan, the experimenter is asked whether to add a new
 * version; resolves with null if not.
 */
async function addOrChange(server: ExperimenterClient, plan: StudyPlan, simulated: boolean): Promise<StudyInfo | null> {
  try {
    return await server.addStudy(plan, simulated);
  } catch (error) {
    if (!(error instanceof Refusal) || error.field !== 'newVersion') throw error;
    if (!confirm(`${formatSentence(error.message)}\n\nMake it a new version? Results keep the versions apart.`))
      return null;
    return server.addStudy(plan, simulated, true);
  }
}

/** Stores simulated participants of a plan in a separate study and opens it. */
export async function simulate(plan: StudyPlan): Promise<void> {
  const simulation = await askForSimulation(plan);
  if (!simulation) return;
  await attempt(async (server) => {
    const onProgress = (done: number, all: number) => {
      notice.value = `Simulating: ${done} of ${all} participants.`;
    };
    const id = await storeSimulation(server, plan, { ...simulation, at: Date.now() / 1000, onProgress });
    await listStudies(server);
    await openStudy(id);
    return `Effects: ${effectsInWords(simulation.effects)} The results of the simulation can be looked at now.`;
  });
}

/** Deletes a simulated study completely. */
export async function deleteSimulated(id: string): Promise<void> {
  if (!confirm(`Delete “${id}” and everything in it? It is simulated: it has no data of people.`)) return;
  await attempt(async (server) => {
    await server.deleteSimulated(id);
    study.value = null;
    await listStudies(server);
    return `“${id}” is deleted.`;
  });
}
