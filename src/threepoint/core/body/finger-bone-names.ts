import type { Side } from '../math/side';
import type { FingerName } from './hand-shape';

/**
 * Returns VRM's names of a finger's three bones, from the palm outwards, without the side. `finger`: the capitalised
 * name.
 */
export const fingerBoneSuffixes = (finger: string): readonly [string, string, string] =>
  finger === 'Thumb'
    ? ['ThumbMetacarpal', 'ThumbProximal', 'ThumbDistal']
    : [`${finger}Proximal`, `${finger}Intermediate`, `${finger}Distal`];

/** Returns VRM's names of a finger's three bones on this side. */
export function fingerBoneNames(side: Side, finger: FingerName): readonly [string, string, string] {
  const [first, second, third] = fingerBoneSuffixes(finger[0]!.toUpperCase() + finger.slice(1));
  return [`${side}${first}`, `${side}${second}`, `${side}${third}`];
}
