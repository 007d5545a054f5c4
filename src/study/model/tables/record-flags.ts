import type { StoredRecord } from '../records/study-record';

/** How far a device's clock may be ahead of the server's [s]. */
const aheadSeconds = 300;
/** How long a record may wait on a device [s]. */
const waitingSeconds = 366 * 86_400;

type PlacedRecord = Extract<StoredRecord, { kind: 'trial' | 'answers' }>;

const isPlaced = (record: StoredRecord): record is PlacedRecord => record.kind === 'trial' || record.kind === 'answers';

const blockKey = (participant: string, { task, block }: { readonly task: string; readonly block: number }): string =>
  `${participant} ${task}/${block}`;

/** Returns a key that two results have in common which one session cannot both give. */
function resultKey(record: PlacedRecord): string {
  const { place } = record.body;
  const asked =
    record.kind === 'trial' ? `${record.body.condition} ${record.body.repetition}` : record.body.questionnaire;
  return `${record.kind} ${blockKey(record.participant, place)}@${place.run} ${asked}`;
}

function hasWrongClock({ at, receivedAt }: StoredRecord): boolean {
  return receivedAt !== undefined && (at > receivedAt + aheadSeconds || at < receivedAt - waitingSeconds);
}

/**
 * Returns a function to the reasons why a record is doubtful, separated by semicolons; empty: none. clock: the device's
 * clock was wrong. repeated: an earlier record has a result of the same trial or questionnaire. run: the block was not
 * voided often enough for this run. hits: more hits than shots. Each can be caused by a broken device, hence such
 * records are stored and counted.
 */
export function recordFlags(records: readonly StoredRecord[]): (record: StoredRecord) => string {
  const voids = new Map<string, number>();
  const first = new Map<string, StoredRecord>();
  for (const record of records) {
    if (record.kind === 'event' && record.body.type === 'void-block' && record.body.repeat) {
      const key = blockKey(record.participant, record.body);
      voids.set(key, (voids.get(key) ?? 0) + 1);
    }
    if (isPlaced(record) && !first.has(resultKey(record))) first.set(resultKey(record), record);
  }
  return (record) => {
    const flags: string[] = hasWrongClock(record) ? ['clock'] : [];
    if (isPlaced(record)) {
      const { place } = record.body;
      if (first.get(resultKey(record)) !== record) flags.push('repeated');
      if (place.run > 1 + (voids.get(blockKey(record.participant, place)) ?? 0)) flags.push('run');
    }
    if (record.kind === 'trial' && record.body.outcome.hits > record.body.outcome.shots) flags.push('hits');
    return flags.join('; ');
  };
}
