import type { BoneMap } from 'threepoint/core';
import { fileNameOf } from 'threepoint-ui';

/** A file of this device, or the address of a file. */
export type MocapFile = File | string;

/** The files of one motion: BVH, VRM Animation, or AMC with its skeleton; and a map of the skeleton if it has one. */
export interface MocapFiles {
  readonly motion: MocapFile;
  /** The skeleton of an AMC file; null: not an AMC file. */
  readonly skeleton: MocapFile | null;
  /** The map of a skeleton that the matcher does not know (JSON); null: none. */
  readonly map: MocapFile | null;
}

/** The bone maps that the user gave for files of motion. */
export interface GivenBones {
  /** The user's new map for these files; null: none. */
  readonly bones: BoneMap | null;
  /** The maps that are stored, by the hashes of the files. */
  readonly boneMaps: Readonly<Record<string, BoneMap>>;
}

const endingOf = (file: MocapFile): string => fileNameOf(file).split('.').at(-1)!.toLowerCase();

export const isMap = (file: MocapFile): boolean => endingOf(file) === 'json';

/**
 * Assigns files to motion, skeleton and map by their endings. Throws a sentence if a part is missing. `others`: the
 * names of the files that remain.
 */
export function pairFiles(files: readonly MocapFile[]): MocapFiles & { readonly others: readonly string[] } {
  const [motion] = files.filter((file) => !['asf', 'json'].includes(endingOf(file)));
  const [map = null] = files.filter(isMap);
  const skeletons = files.filter((file) => endingOf(file) === 'asf');
  if (!motion && map)
    throw new Error(`${fileNameOf(map)}: a skeleton map without motion; open it together with the motion`);
  if (!motion)
    throw new Error(`${fileNameOf(skeletons[0]!)}: a skeleton without motion; open it together with its .amc`);
  const without = (taken: readonly MocapFile[]) => files.filter((file) => !taken.includes(file)).map(fileNameOf);
  const given = map ? [map] : [];
  if (endingOf(motion) !== 'amc') return { motion, skeleton: null, map, others: without([motion, ...given]) };
  const name = fileNameOf(motion);
  const stemOf = (file: MocapFile): string => fileNameOf(file).replace(/\.asf$/i, '');
  // Both 10.asf and 105.asf match the start of 105_01.amc: the longer name is right.
  const likely = skeletons.filter((file) => name.startsWith(stemOf(file)));
  const [own = skeletons[0]] = likely.sort((a, b) => stemOf(b).length - stemOf(a).length);
  if (!own) throw new Error(`${name}: a motion without its skeleton; open it together with its .asf`);
  return { motion, skeleton: own, map, others: without([motion, own, ...given]) };
}
