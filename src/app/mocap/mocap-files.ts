import { nameOf } from '../../ui/limited-files';

/** A file of this device, or the address of one. */
export type MocapFile = File | string;

/** Files that make one motion: a BVH, a VRM Animation, or an AMC with its skeleton. */
export interface MocapFiles {
  readonly motion: MocapFile;
  /** Of an AMC. */
  readonly skeleton: MocapFile | null;
}

const endingOf = (file: MocapFile): string => nameOf(file).split('.').at(-1)!.toLowerCase();

/**
 * Which of these files is the motion and which its skeleton. Throws a sentence where a part is missing; `others`: names of what is left over.
 */
export function pairFiles(files: readonly MocapFile[]): MocapFiles & { readonly others: readonly string[] } {
  const [motion] = files.filter((file) => endingOf(file) !== 'asf');
  const skeletons = files.filter((file) => endingOf(file) === 'asf');
  if (!motion) throw new Error(`${nameOf(skeletons[0]!)}: a skeleton without motion; open its .amc together with it`);
  const without = (taken: readonly MocapFile[]) => files.filter((file) => !taken.includes(file)).map(nameOf);
  if (endingOf(motion) !== 'amc') return { motion, skeleton: null, others: without([motion]) };
  const name = nameOf(motion);
  const own = skeletons.find((file) => name.startsWith(nameOf(file).replace(/\.asf$/i, ''))) ?? skeletons[0];
  if (!own) throw new Error(`${name}: a motion without its skeleton; open its .asf together with it`);
  return { motion, skeleton: own, others: without([motion, own]) };
}
