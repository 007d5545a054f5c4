import { ServerRefusal } from '../client/study-client';
import type { StudyRecord } from '../model/records/study-record';
import type { SessionStore } from './session-store';

type Send = (records: readonly StudyRecord[]) => Promise<readonly string[]>;

/**
 * Sends what a session recorded, batch by batch; `send` answers with the ids that the server has. What the server will not take stays
 * and does not hold up the rest: the answer is why it was refused, null where nothing was. Rejects where there is no server, or none for
 * this device.
 */
export async function sendRecords(store: SessionStore, send: Send): Promise<string | null> {
  const refused = new Set<string>();
  let reason: string | null = null;
  for (let batch = store.nextBatch(refused); batch.length > 0; batch = store.nextBatch(refused)) {
    const refusal = await sendOrRefuse(store, send, batch);
    if (refusal === null) continue;
    // One of them is at fault: each goes by itself.
    for (const record of batch) {
      const why = batch.length === 1 ? refusal : await sendOrRefuse(store, send, [record]);
      if (why === null) continue;
      refused.add(record.id);
      reason = why;
    }
  }
  return reason;
}

/** Why the server takes none of these records; null: it has them. */
async function sendOrRefuse(store: SessionStore, send: Send, records: readonly StudyRecord[]): Promise<string | null> {
  try {
    await store.acknowledge(await send(records));
    return null;
  } catch (error) {
    if (!(error instanceof ServerRefusal) || error.status === 401) throw error;
    return error.message;
  }
}
