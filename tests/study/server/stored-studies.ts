import { join } from 'node:path';
import { onTestFinished } from 'vitest';
import { checkedRecord, type StoredRecord, type StudyRecord } from '../../../src/study/model/records/study-record';
import { openStudyStore, type StudyStore } from '../../../src/study/server/sqlite/study-store';
import { directoryWith } from '../../temporary-directory';
import { completed, paperPlan } from '../model/studies';
import { now } from './running-studies';

/** Opens a store in a new file or in this one; it is closed when the test ends. */
export function opened(
  file = join(directoryWith(), 'studies.db'),
  options: Parameters<typeof openStudyStore>[1] = {},
): { store: StudyStore; file: string } {
  const store = openStudyStore(file, options);
  let open = true;
  const close = store.close;
  store.close = () => {
    if (open) close();
    open = false;
  };
  onTestFinished(() => store.close());
  return { store, file };
}

/** Returns a store with the paper's study. */
export function withPaperStudy(options = { simulated: false }) {
  const { store, file } = opened();
  store.plans.add(paperPlan(), { ...options, at: now });
  return { store, file };
}

/** Opens this file as a store of the paper's study: P01 has finished, P02 has come, P03 is invited. */
export function startedStudy(file: string) {
  const store = openStudyStore(file);
  const at = Date.now() / 1000;
  const plan = paperPlan();
  store.plans.add(plan, { simulated: false, at });
  const claims = { P01: store.places.claim('paper', 'P01', at), P02: store.places.claim('paper', 'P02', at) };
  const records = completed('P01', { motion: true }).map((record) => checkedRecord(record, plan));
  store.records.store('paper', 'P01', records, at);
  const placeOf = (name: string) => store.overview('paper', at).find(({ participant }) => participant === name);
  return {
    records,
    claims,
    invitation: placeOf('P03')?.invitation,
    isAsBegun: () =>
      store.places.holds('paper', 'P01', claims.P01.token) &&
      store.places.holds('paper', 'P02', claims.P02.token) &&
      placeOf('P03')?.claimed === false,
    close: () => store.close(),
  };
}

/** Returns a stored record as it was sent, without what the server has added. */
export const asSent = ({ author: _author, receivedAt: _receivedAt, ...record }: StoredRecord): StudyRecord =>
  record as StudyRecord;
