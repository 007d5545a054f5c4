import { join } from 'node:path';
import { onTestFinished } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import type { StoredRecord, StudyRecord } from '../../../src/study/model/records/study-record';
import { openStudyStore, type StudyStore } from '../../../src/study/server/sqlite/study-store';
import { directoryWith } from '../../temporary-directory';
import { paperPlan, session } from '../model/studies';
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

/** Returns the records of a complete session; `motion` is the consent to recordings. */
export function completed(participant = 'P01', { simulated = false, motion = false } = {}): StudyRecord[] {
  const schedule = scheduleFor(paperPlan(), participant);
  const one = session(schedule, simulated);
  one.tell({ type: 'consent', version: schedule.consentVersion, motion });
  one.doUntil(({ kind }) => kind === 'end');
  return one.records;
}

/** Returns a stored record as it was sent, without what the server has added. */
export const asSent = ({ author: _author, receivedAt: _receivedAt, ...record }: StoredRecord): StudyRecord =>
  record as StudyRecord;
