import { type FileKind, nameOf, type ReadOptions, readLimited } from '../../ui/limited-files';

/** A motion capture file with its name. */
export interface MocapFile {
  readonly name: string;
  readonly bytes: ArrayBuffer;
}

/** What the readers take; half an hour of all joints at 120 Hz. */
const mocapFile: FileKind = { what: 'a motion capture file', megabytes: 200 };

/** The bytes of files of this device, or of what addresses answer. */
export const fetchMocap = (sources: readonly (File | string)[], options: ReadOptions): Promise<MocapFile[]> =>
  Promise.all(
    sources.map(async (source) => ({ name: nameOf(source), bytes: await readLimited(source, mocapFile, options) })),
  );

/** Files that make one motion: a BVH, a VRM Animation, or an AMC with its skeleton. */
export interface MocapFiles {
  readonly motion: MocapFile;
  /** Of an AMC. */
  readonly skeleton: MocapFile | null;
}

const endingOf = (name: string): string => name.split('.').at(-1)!.toLowerCase();

/**
 * Which of these files is the motion and which its skeleton. Throws a sentence where a part is missing; `others`: names of what is left over.
 */
export function pairFiles(files: readonly MocapFile[]): MocapFiles & { readonly others: readonly string[] } {
  const [motion] = files.filter(({ name }) => endingOf(name) !== 'asf');
  const skeletons = files.filter(({ name }) => endingOf(name) === 'asf');
  if (!motion) throw new Error(`${skeletons[0]!.name}: a skeleton without motion; open its .amc together with it`);
  if (endingOf(motion.name) !== 'amc') return { motion, skeleton: null, others: namesWithout(files, [motion]) };
  const own = skeletons.find(({ name }) => motion.name.startsWith(name.replace(/\.asf$/i, ''))) ?? skeletons[0];
  if (!own) throw new Error(`${motion.name}: a motion without its skeleton; open its .asf together with it`);
  return { motion, skeleton: own, others: namesWithout(files, [motion, own]) };
}

const namesWithout = (files: readonly MocapFile[], taken: readonly MocapFile[]): readonly string[] =>
  files.filter((file) => !taken.includes(file)).map(({ name }) => name);
