import { formatSentence } from 'threepoint-ui';
import type { ExperimenterClient } from '../../client/study-client';
import { readPlan, type StudyPlan } from '../../model/plan/plan';
import { Rejection } from '../../model/progress/rejection';
import type { StudyInfo } from '../../model/progress/study-api';
import { effectsInWords } from '../../simulation/simulate-study';
import { listStudies, putIntoAddress } from '../experimenter-access';
import { attempt, notice, openStudy, study } from './experimenter-state';
import { askForSimulation } from './simulation-dialog';
import { addCopy, storeSimulation } from './store-simulation';

/** A new study: `name` is for messages, `json` reads its file. */
interface NewStudy {
  readonly name: string;
  readonly simulated: boolean;
  json(): Promise<string>;
}

/** Adds a study and opens it. */
export const addStudy = ({ name, simulated, json }: NewStudy) =>
  attempt(async (server) => {
    const read = readPlan(await json(), name);
    if ('problems' in read) throw new Error(read.problems.map(({ message }) => message).join('\n'));
    const { plan } = read;
    if (simulated) return openCopy(server, plan);
    const info = await addOrChange(server, plan);
    if (!info) return `Nothing was changed: the study “${plan.id}” keeps its plan.`;
    await listStudies(server);
    await openStudy(plan.id);
    return `${name} is on this server${info.versions.length > 1 ? `, as version ${info.version} of the plan` : ''}.`;
  });

/**
 * Adds a study. If one of the same id has begun with another plan, the experimenter is asked whether to add a new
 * version; resolves with null if not.
 */
async function addOrChange(server: ExperimenterClient, plan: StudyPlan): Promise<StudyInfo | null> {
  try {
    return await server.addStudy(plan, false);
  } catch (error) {
    if (!(error instanceof Rejection) || error.field !== 'newVersion') throw error;
    if (!confirm(`${formatSentence(error.message)}\n\nMake it a new version? Results keep the versions apart.`))
      return null;
    return server.addStudy(plan, false, true);
  }
}

/** Opens a simulated copy of a study; an earlier one is deleted with its records. */
async function openCopy(server: ExperimenterClient, plan: StudyPlan): Promise<string> {
  const { id } = await addCopy(server, plan, 'try');
  await listStudies(server);
  await openStudy(id);
  return `Open the page of a participant to try “${id}”. Its records are deleted with it.`;
}

/** Opens a copy of a study, in which the experimenter can take part. */
export const tryOut = (plan: StudyPlan) => attempt((server) => openCopy(server, plan));

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
    return `Effects: ${effectsInWords(simulation.effects)} Its results can be opened now.`;
  });
}

export async function deleteSimulated(id: string): Promise<void> {
  if (!confirm(`Delete “${id}” and everything in it? It is simulated: it has no data of people.`)) return;
  await attempt(async (server) => {
    await server.deleteSimulated(id);
    study.value = null;
    putIntoAddress(null);
    await listStudies(server);
    return `“${id}” is deleted.`;
  });
}
