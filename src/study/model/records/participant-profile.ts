import type { Calibration } from 'threepoint/core';
import type { Side } from 'threepoint/math';
import type { Demographics } from './demographics';
import type { StudyRecord } from './study-record';

/** The data about a participant that the page needs on another device. */
export interface ParticipantProfile {
  /** The preferred hand, which draws the bow; null: not asked yet. */
  readonly preferredHand: Side | null;
  /** The newest measures of the body; null: not measured yet. */
  readonly calibration: Calibration | null;
}

/** Returns the drawing hand; participants without a preference draw with the right one. */
export const preferredHandOf = ({ handedness }: Pick<Demographics, 'handedness'>): Side =>
  handedness === 'left' ? 'left' : 'right';

/**
 * Returns the profile from records, the oldest first. How headset and hands are worn depends on the device and is left
 * out.
 */
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
