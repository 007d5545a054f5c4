import { signal } from '@preact/signals';
import { reasonOf } from 'threepoint/core';
import type { ExperimenterClient } from '../../client/study-client';
import { Rejection } from '../../model/progress/rejection';
import type { ParticipantState, Receipt, StudyInfo } from '../../model/progress/study-api';
import { client, requestStudy } from '../experimenter-access';

export interface OpenStudy extends StudyInfo {
  readonly states: readonly ParticipantState[];
  /** The time at which the states were received, by the clock of this page [s since 1970]. */
  readonly receivedAt: number;
  readonly receipts: readonly Receipt[];
}

/** Returns the plan of the version that a participant follows, or the newest plan. */
export const planOf = ({ plan, versions }: Pick<OpenStudy, 'plan' | 'versions'>, followed: number | undefined) =>
  versions.find(({ version }) => version === followed)?.plan ?? plan;

/** The study that is open; null: none. */
export const study = signal<OpenStudy | null>(null);
/** The result of the last action. */
export const notice = signal('');
/** Why the last action failed. */
export const problem = signal('');
export const online = signal(true);
/** The time of the last refresh, by the clock of this page [s since 1970]. */
export const refreshedAt = signal(0);

/** Requests what changes while a study runs. */
async function requestState(server: ExperimenterClient, id: string) {
  const states = await server.participants(id);
  const receivedAt = Date.now() / 1000;
  return { states, receivedAt, receipts: await server.receipts(id) };
}

/** Opens a study, or shows why it cannot be opened. */
export async function openStudy(id: string): Promise<void> {
  const server = client.value;
  if (!server || !id) return;
  problem.value = '';
  try {
    const { records: _, ...info } = await requestStudy(server, id);
    study.value = { ...info, ...(await requestState(server, id)) };
  } catch (error) {
    problem.value = reasonOf(error);
  }
}

export async function refresh(): Promise<void> {
  const server = client.value;
  const id = study.value?.plan.id;
  if (!server || id === undefined) return;
  try {
    const state = await requestState(server, id);
    // Another study may have been opened in the meantime.
    if (study.value?.plan.id === id) study.value = { ...study.value, ...state };
    online.value = true;
  } catch (error) {
    online.value = false;
    if (error instanceof Rejection) problem.value = error.message;
  }
  refreshedAt.value = Date.now() / 1000;
}

/**
 * Runs an action with the server, and shows the notice that it resolves with, or why it failed. `id` is that of the
 * open study, or an empty text.
 */
export async function attempt(
  action: (server: ExperimenterClient, id: string) => Promise<string | null>,
): Promise<void> {
  if (!client.value) return;
  try {
    notice.value = (await action(client.value, study.value?.plan.id ?? '')) ?? '';
    problem.value = '';
  } catch (error) {
    problem.value = reasonOf(error);
  }
  await refresh();
}
