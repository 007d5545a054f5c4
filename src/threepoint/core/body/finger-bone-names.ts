import type { Side } from '../math/side';
import type { FingerName } from './hand-shape';

/** VRM's names of the three bones of a finger with this name, capitalised, from the palm outwards, without the side. */
export const fingerBoneSuffixes = (finger: string): readonly [string, string, string] =>
  finger === 'Thumb'
    ? ['ThumbMetacarpal', 'ThumbProximal', 'ThumbDistal']
    : [`${finger}Proximal`, `${finger}Intermediate`, `${finger}Distal`];

/** Returns the names of a finger's bones with their side. */
export function fingerBoneNames(side: Side, finger: FingerName): readonly [string, string, string] {
  const [first, second, third] = fingerBoneSuffixes(finger[0]!.toUpperCase() + finger.slice(1));
  return [`${side}${first}`, `${side}${second}`, `${side}${third}`];
}
