import { type Calibration, calibrationProblem } from '../body/calibration';
import { reasonOf } from '../errors/reasons';
import type { BoneMap } from '../humanoid/bones';
import { type FileBones, UnknownBonesError } from '../humanoid/unknown-bones-error';
import { isObject } from '../json';
import type { ImportedMotion } from '../motion/imported-motion';
import { readAmc } from '../motion/read-amc';
import { readAsf } from '../motion/read-asf';
import { importedBvhMotion, readBvh } from '../motion/read-bvh';
import { readGlbMotion } from '../motion/read-glb-motion';
import { readVrma } from '../motion/read-vrma';
import { finishWork, scaleProgress } from '../motion/work';
import { restoreLostBones } from './cmuconvert';
import { doubtsOf } from './doubts';
import { floorFromFile, fromMappedRest } from './mapped-motion';
import { jointsToDraw, type MatchedMotion, matchSkeleton } from './match-skeleton';
import mocapRules from './mocap-rules.json' with { type: 'json' };
import { floorHeight, measuresOf, neutralHead } from './person';
import { readSkeletonMap } from './read-skeleton-map';
import { resampleClip, splitAtJumps } from './resampled-clip';
import { simulateTrackers } from './simulate-trackers';
import { acclaimMap, mappedSkeleton, type SkeletonMap } from './skeleton-map';
import { type TruthMotion, toTruthMotion, unitOf } from './truth-motion';

const { cmu, rateHz, usualRateHz } = mocapRules;

/** The text of a further file that a motion file needs, with its name. */
interface NamedText {
  readonly name: string;
  readonly text: string;
}

/** The content of a file of motion, with its name. */
export type MocapSource = {
  readonly name: string;
  /** The map of a skeleton that is unknown here. */
  readonly map?: NamedText;
  /** The user's map of the file's bones, for a file without the map above. */
  readonly bones?: BoneMap;
  /** The BVH or AMC file that the map's `restFrame` is of, where it is another. */
  readonly rest?: NamedText;
  /** The frame rate [Hz] of a file that does not state its own. */
  readonly rateHz?: number;
} & (
  | { readonly format: 'bvh'; readonly text: string }
  | {
      readonly format: 'amc';
      readonly text: string;
      readonly skeleton: NamedText;
    }
  | { readonly format: 'gltf'; readonly description: unknown; readonly binary: Uint8Array }
);

/** A person's motion as tracked by a headset and two hands, with the ground truth; 60 frames a second. */
export interface MocapClip {
  readonly name: string;
  readonly calibration: Calibration;
  readonly frameCount: number;
  /** `trackedWidth` numbers for each frame: head, left wrist, right wrist. */
  readonly tracked: Float32Array<ArrayBuffer>;
  /** x, y, z of `truthJoints` for each frame, floor frame [m]; NaN: the file has no such joint. */
  readonly truth: Float32Array<ArrayBuffer>;
}

/** The range of frame rates [Hz] that are read; a lower one is a list of poses. */
const lowestRateHz = 5;
const highestRateHz = 5000;

/** The frame rate [Hz] of every clip. */
export const mocapRateHz = rateHz;

/** The clips of a file, with notes on what was corrected or assumed, a sentence each. */
export interface PreparedMocap {
  readonly clips: readonly MocapClip[];
  /** The frame rate of the file [Hz]. */
  readonly rateHz: number;
  readonly notes: readonly string[];
  /** The implausible properties of the motion, a sentence each. */
  readonly doubts: readonly string[];
  /** The joints of the file, and which bones they are. */
  readonly bones: FileBones;
}

/** A file's motion before it is cut into clips. */
export type ReadMocap = { readonly motion: TruthMotion } & Omit<PreparedMocap, 'clips' | 'rateHz'>;

/** Returns the fault as a sentence that begins with the name of its file. */
function faultIn(name: string, error: unknown): Error {
  const message = `${name}: ${reasonOf(error)}`;
  return error instanceof UnknownBonesError
    ? new UnknownBonesError(message, error)
    : new Error(message, { cause: error });
}

/** Reads a further file; a fault in it begins with its own name. */
function readNamedText<Result>({ name, text }: NamedText, read: (text: string, name: string) => Result): Result {
  try {
    return read(text, name);
  } catch (error) {
    throw faultIn(name, error);
  }
}

/** Reads a BVH file, with its lost bones restored. */
function* readBvhFile(text: string) {
  const motion = yield* readBvh(text);
  const { joints, notes } = restoreLostBones(motion.joints);
  return { motion, joints, file: importedBvhMotion(motion, joints, [...motion.notes, ...notes]) };
}

const readAmcFile = (text: string, skeleton: NamedText): Generator<number, ImportedMotion> =>
  readAmc(text, readNamedText(skeleton, readAsf), skeleton.name);

/** Reads a file and finds its skeleton: by the given map, by the format, or by matching. */
function* readFile(source: MocapSource, map: SkeletonMap | undefined): Generator<number, MatchedMotion> {
  const bvh = source.format === 'bvh' ? yield* readBvhFile(source.text) : null;
  const file = bvh?.file ?? (yield* readOther(source));
  if (!map) {
    const acclaim = source.format === 'amc' && !source.bones ? acclaimMap(file.names) : null;
    return acclaim ? withMap(file, acclaim) : matchSkeleton(file, source.bones);
  }
  if (map.restFile !== undefined && !source.rest)
    throw new Error(
      '“restFrame” of another file is for npm run tool -- evaluate; here it is the number of a frame of the file',
    );
  const rest =
    source.rest &&
    readNamedText(source.rest, (text) =>
      source.format === 'amc' ? finishWork(readAmcFile(text, source.skeleton)) : finishWork(readBvhFile(text)).file,
    );
  return withMap(fromMappedRest(file, map, bvh, map.restFile === undefined ? undefined : rest), map);
}

function* readOther(source: MocapSource): Generator<number, ImportedMotion> {
  if (source.format === 'gltf') return readGltf(source.description, source.binary);
  if (source.format === 'amc') return yield* readAmcFile(source.text, source.skeleton);
  throw new Error('no file of motion');
}

/** Reads a VRM Animation, which names its bones, or the clip of another file. */
function readGltf(description: unknown, binary: Uint8Array): ImportedMotion {
  if (!isObject(description)) throw new Error('its description is no object');
  const { extensions } = description;
  const isVrma = isObject(extensions) && extensions.VRMC_vrm_animation !== undefined;
  return isVrma ? readVrma(description, binary) : readGlbMotion(description, binary);
}

const withMap = (file: ImportedMotion, map: SkeletonMap): MatchedMotion => ({
  file,
  skeleton: mappedSkeleton(file.names, map, floorFromFile(map)),
  bones: { joints: jointsToDraw(file), matched: map.joints, confidence: {} },
  notes: [],
  doubts: [],
});

const stemOf = (name: string): string => name.replace(/\.[^.]*$/, '');

/**
 * Returns the rate [Hz] of a file that does not state it: that of the CMU database, by the file's name, else the usual
 * one of its format, with a note.
 */
function usualRate({ name, format }: MocapSource): { readonly rate: number; readonly notes: readonly string[] } {
  const usual = format === 'amc' ? usualRateHz.amc : usualRateHz.bvh;
  const cmuName = format === 'amc' && /^0*(\d+)_0*\d+$/.exec(stemOf(name));
  if (cmuName) return { rate: cmu.subjectsAt60Hz.includes(Number(cmuName[1])) ? 60 : usual, notes: [] };
  const note = `it does not state its frame rate; ${usual} frames a second are assumed. “frameRate” in a skeleton map states it`;
  return { rate: usual, notes: [note] };
}

/** Returns the person's name from the start of the file's, as the evaluation does for files in one folder. */
function personOf(name: string): string {
  const person = stemOf(name).split('_')[0]!;
  return /^\d+$/.test(person) ? String(Number(person)).padStart(3, '0') : person;
}

/**
 * Reads a file's motion in our joints. Yields the fraction [0, 1] that is done. `notes`: what was put right or assumed,
 * a sentence each. Throws a sentence that begins with the file's name.
 */
export function* readTruthMotion(source: MocapSource): Generator<number, ReadMocap> {
  try {
    const map = source.map && readNamedText(source.map, readSkeletonMap);
    const { file, skeleton, bones, notes, doubts } = yield* scaleProgress(readFile(source, map), 0, 0.75);
    const given = file.rateHz ?? map?.frameRate ?? source.rateHz;
    const { rate, notes: assumed } = given === undefined ? usualRate(source) : { rate: given, notes: [] };
    if (!(rate >= lowestRateHz && rate <= highestRateHz))
      throw new Error(
        `it has ${Number(rate.toPrecision(3))} frames a second; motion of ${lowestRateHz} to ${highestRateHz} is read`,
      );
    const unit = unitOf(file, skeleton);
    const motion = yield* scaleProgress(toTruthMotion(file, rate, skeleton, unit.metres), 0.75, 1);
    const said = [...file.notes, ...assumed, ...notes, ...(unit.note ? [unit.note] : [])];
    return { motion, bones, notes: said, doubts: [...doubts, ...doubtsOf(motion)] };
  } catch (error) {
    throw faultIn(source.name, error);
  }
}

/**
 * Simulates what a headset and two hands would have seen of the person in a file, as the evaluation does
 * (docs/accuracy.md). Where the motion leaps it is cut. Yields the fraction [0, 1] that is done. Throws a sentence that
 * begins with the file's name.
 */
export function* prepareMocap(source: MocapSource): Generator<number, PreparedMocap> {
  const read = yield* scaleProgress(readTruthMotion(source), 0, 0.8);
  try {
    return yield* scaleProgress(clipsOf(source.name, read), 0.8, 1);
  } catch (error) {
    throw faultIn(source.name, error);
  }
}

function* clipsOf(name: string, { motion, notes, doubts, bones }: ReadMocap): Generator<number, PreparedMocap> {
  const { cuts, pieces } = splitAtJumps(motion);
  if (pieces.length === 0) throw new Error('nothing in it moves as a person for half a second');
  const calibration = measuresOf(motion, pieces);
  const problem = calibrationProblem(calibration);
  if (problem) throw new Error(problem);
  const neutral = neutralHead(motion, pieces);
  const floor = floorHeight(motion, pieces);
  const clips: MocapClip[] = [];
  for (const [i, piece] of pieces.entries()) {
    yield i / pieces.length;
    const clip = pieces.length === 1 ? stemOf(name) : `${stemOf(name)}#${i + 1}`;
    const even = resampleClip(motion, piece, floor, neutral);
    const tracked = simulateTrackers(even, personOf(name), clip);
    clips.push({ name: clip, calibration, frameCount: even.frameCount, tracked, truth: even.positions });
  }
  const leaps = cuts.slice(0, 5).map((cut) => cut + 1).join(', '); // biome-ignore format: one thought
  const said = cuts.length > 0 ? [...notes, `it leaps at frame ${leaps}; cut there`] : notes;
  return { clips, rateHz: motion.rateHz, doubts, bones, notes: said };
}
