import type { Calibration } from 'threepoint/core/body/calibration';
import type { Side } from 'threepoint/core/math/side';
import type { Demographics } from './demographics';
import type { StudyRecord } from './study-record';

/** What the page goes by of a participant who was asked and measured. */
export interface ParticipantProfile {
  /** The hand they prefer: the bow goes into the other one; null: not told yet. */
  readonly preferredHand: Side | null;
  /** The newest measures of the body; null: not measured yet. */
  readonly calibration: Calibration | null;
}

/** A participant who prefers neither draws with the right one. */
export const preferredHandOf = ({ handedness }: Pick<Demographics, 'handedness'>): Side =>
  handedness === 'left' ? 'left' : 'right';

/** By what was recorded, the oldest first. How headset and hands are worn is another matter on every device, and left out. */
export function profileFrom(records: readonly StudyRecord[]): ParticipantProfile {
  let known: ParticipantProfile = { preferredHand: null, calibration: null };
  for (const record of records) {
    if (record.kind === 'demographics') known = { ...known, preferredHand: preferredHandOf(record.body) };
    if (record.kind !== 'calibration') continue;
    const { eyeHeight, armSpan } = record.body;
    known = { ...known, calibration: { eyeHeight, armSpan } };
  }
  return known;
}
