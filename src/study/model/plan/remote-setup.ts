import { numberBetween, text } from 'threepoint/core/validation/validation';
import * as v from 'valibot';
import type { Phrases } from '../phrases/phrases';

/** How a participant takes part with no one beside them. */
export const remoteSchema = v.strictObject({
  /** Whom they write to or call when something goes wrong, as it is shown to them. */
  contact: text(120),
  /** The room that the games need on either side [m]. */
  freeSpace: numberBetween(0.5, 5),
});

export type RemoteTerms = v.InferOutput<typeof remoteSchema>;

/** Why nothing can be played on a device; `reason`: as the browser says it. */
export type DeviceFault =
  | { readonly kind: 'insecure' | 'no-webxr' | 'no-headset' }
  | { readonly kind: 'refused'; readonly reason: string };

/** What the device knows of a participant who is about to begin. */
export interface RemoteSetup {
  /** null: it can be played on. */
  readonly deviceFault: DeviceFault | null;
  /** The room that the headset's boundary leaves [m]; null: the headset does not tell. */
  readonly room: { readonly width: number; readonly depth: number } | null;
  /** Above the floor as just seen [m]; null: not yet. */
  readonly eyeHeight: number | null;
}

/** Eyes of people who stand are within these heights [m]: below, the floor is wrong or they sit; above, the floor is wrong. */
const standing = { least: 1.1, most: 2.05 };

/** What is wrong before the start and what to do about it, a sentence each in the participant's language; empty: nothing. */
export function setupFaults(
  { freeSpace }: RemoteTerms,
  { deviceFault, room, eyeHeight }: RemoteSetup,
  phrases: Phrases,
): readonly string[] {
  const { say } = phrases;
  if (deviceFault !== null) return [say('setup.openThere', { fault: deviceFaultText(deviceFault, phrases) })];
  const faults: string[] = [];
  if (room && Math.min(room.width, room.depth) < freeSpace) {
    const [width, depth] = [phrases.metres(room.width), phrases.metres(room.depth)];
    faults.push(say('setup.room', { width, depth, needed: phrases.metres(freeSpace) }));
  }
  if (eyeHeight !== null && eyeHeight < standing.least) {
    faults.push(say('setup.low', { height: phrases.metres(eyeHeight) }));
  }
  if (eyeHeight !== null && eyeHeight > standing.most) {
    faults.push(say('setup.high', { height: phrases.metres(eyeHeight) }));
  }
  return faults;
}

function deviceFaultText(fault: DeviceFault, { say }: Phrases): string {
  switch (fault.kind) {
    case 'insecure':
      return say('setup.insecure');
    case 'no-webxr':
      return say('setup.noWebxr');
    case 'no-headset':
      return say('setup.noHeadset');
    case 'refused':
      return say('setup.refused', { reason: fault.reason });
  }
}
