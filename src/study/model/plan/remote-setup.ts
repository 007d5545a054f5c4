import { numberBetween, text } from 'threepoint/core';
import * as v from 'valibot';
import type { Phrases } from '../phrases/phrases';

/** The terms for a participant who takes part alone. */
export const remoteSchema = v.strictObject({
  /** The contact in case of trouble, as participants read it. */
  contact: text(120),
  /** The room that the games need on either side [m]. */
  freeSpace: numberBetween(0.5, 5),
});

export type RemoteTerms = v.InferOutput<typeof remoteSchema>;

/** Why nothing can be played on a device; `reason` is the message of the browser. */
export type DeviceProblem =
  | { readonly kind: 'insecure' | 'no-webxr' | 'no-headset' }
  | { readonly kind: 'refused'; readonly reason: string };

export interface RemoteSetup {
  /** null: the device can be used. */
  readonly deviceProblem: DeviceProblem | null;
  /** The room within the headset's boundary [m]; null: it is not reported. */
  readonly room: { readonly width: number; readonly depth: number } | null;
  /** The measured height of the eyes above the floor [m]; null: not measured yet. */
  readonly eyeHeight: number | null;
}

/** The range of eye heights of standing people [m]: outside of it the floor is wrong, or the participant sits. */
const standing = { least: 1.1, most: 2.05 };

/**
 * Returns what is wrong with a set-up and how to repair it, each in a sentence in the participant's language; empty:
 * nothing.
 */
export function setupProblems(
  { freeSpace }: RemoteTerms,
  { deviceProblem, room, eyeHeight }: RemoteSetup,
  phrases: Phrases,
): readonly string[] {
  const { text } = phrases;
  if (deviceProblem !== null) return [text('setup.openThere', { fault: deviceProblemText(deviceProblem, phrases) })];
  const problems: string[] = [];
  if (room && Math.min(room.width, room.depth) < freeSpace) {
    const [width, depth] = [phrases.metres(room.width), phrases.metres(room.depth)];
    problems.push(text('setup.room', { width, depth, needed: phrases.metres(freeSpace) }));
  }
  if (eyeHeight !== null && eyeHeight < standing.least) {
    problems.push(text('setup.low', { height: phrases.metres(eyeHeight) }));
  }
  if (eyeHeight !== null && eyeHeight > standing.most) {
    problems.push(text('setup.high', { height: phrases.metres(eyeHeight) }));
  }
  return problems;
}

function deviceProblemText(problem: DeviceProblem, { text }: Phrases): string {
  switch (problem.kind) {
    case 'insecure':
      return text('setup.insecure');
    case 'no-webxr':
      return text('setup.noWebxr');
    case 'no-headset':
      return text('setup.noHeadset');
    case 'refused':
      return text('setup.refused', { reason: problem.reason });
  }
}
