import { Rejection } from '../../model/progress/rejection';
import type { StudyRecord } from '../../model/records/study-record';
import type { SessionStore } from './session-store';

type Send = (records: readonly StudyRecord[]) => Promise<readonly string[]>;

/**
 * Sends the records of a session in batches; `send` resolves with the ids that the server has. Refused records are kept
 * and do not delay the others. Resolves with the reason of a refusal, or null; rejects if there is no server, or none
 * for this device.
 */
export async function sendRecords(store: SessionStore, send: Send): Promise<string | null> {
  const rejectionOfAll = (records: readonly StudyRecord[]) =>
    rejectionOf(async () => store.acknowledge(await send(records)));
  const rejected = new Set<string>();
  let reason: string | null = null;
  for (let batch = store.nextBatch(rejected); batch.length > 0; batch = store.nextBatch(rejected)) {
    const rejection = await rejectionOfAll(batch);
    if (rejection === null) continue;
    // One of them is at fault, so each is sent separately.
    for (const record of batch) {
      const why = batch.length === 1 ? rejection : await rejectionOfAll([record]);
      if (why === null) continue;
      rejected.add(record.id);
      reason = why;
    }
  }
  return reason;
}

/** Sends something; resolves with why the server refuses it, or with null. Rejects if none serves this device. */
export async function rejectionOf(send: () => Promise<void>): Promise<string | null> {
  try {
    await send();
    return null;
  } catch (error) {
    if (!(error instanceof Rejection) || error.reason === 'unauthorised') throw error;
    return error.message;
  }
}
