import * as v from 'valibot';
import { numberBetween, text } from './validation';

/** How a participant takes part with no one beside them. */
export const remoteSchema = v.strictObject({
  /** Whom they write to or call when something goes wrong, as it is shown to them. */
  contact: text(120),
  /** The room that the games need on either side [m]. */
  freeSpace: numberBetween(0.5, 5),
});

export type RemoteTerms = v.InferOutput<typeof remoteSchema>;

/** What the device knows of a participant who is about to begin. */
export interface RemoteSetup {
  /** Why nothing can be played on this device; null: it can. */
  readonly deviceFault: string | null;
  /** The room that the headset's boundary leaves [m]; null: the headset does not tell. */
  readonly room: { readonly width: number; readonly depth: number } | null;
  /** Above the floor as just seen [m]; null: not yet. */
  readonly eyeHeight: number | null;
}

/** Eyes of people who stand are within these heights [m]: below, the floor is wrong or they sit; above, the floor is wrong. */
const standing = { least: 1.1, most: 2.05 };

const metres = (length: number) => `${length.toFixed(1)} m`;

/** What is wrong before the start and what to do about it, a sentence each; empty: nothing. */
export function setupFaults(
  { freeSpace }: RemoteTerms,
  { deviceFault, room, eyeHeight }: RemoteSetup,
): readonly string[] {
  if (deviceFault !== null) return [`${deviceFault} Open this link in the browser of your headset.`];
  const faults: string[] = [];
  if (room && Math.min(room.width, room.depth) < freeSpace) {
    faults.push(
      `Your boundary leaves ${metres(room.width)} by ${metres(room.depth)}, the games need ${metres(freeSpace)} on either side. Clear more room and draw the boundary anew.`,
    );
  }
  if (eyeHeight !== null && eyeHeight < standing.least) {
    faults.push(
      `Your eyes were measured ${metres(eyeHeight)} above the floor. Stand up; if you do, the headset has the floor too high: set it anew in its settings.`,
    );
  }
  if (eyeHeight !== null && eyeHeight > standing.most) {
    faults.push(
      `Your eyes were measured ${metres(eyeHeight)} above the floor: the headset has the floor too low. Set it anew in its settings.`,
    );
  }
  return faults;
}
