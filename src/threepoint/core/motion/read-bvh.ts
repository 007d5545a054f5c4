import { fromAxisAngle, multiply, quat, rotate, setQuat } from '../math/quat';
import { add, copyVec3, type Vec3, vec3, zero } from '../math/vec3';
import { type ImportedMotion, type SkeletonPose, unitAxes } from './imported-motion';
import { Lines, Rows, shown, type Word } from './lines';

type Axis = keyof typeof unitAxes;
interface BvhChannel {
  /** `unused`: a position that only repeats the joint's offset, or none at all. */
  readonly kind: 'position' | 'rotation' | 'unused';
  readonly axis: Axis;
}

/** A joint of a file; an end site is a joint without channels, called “<parent>:end”. */
export interface BvhJoint {
  readonly name: string;
  /** The index of the parent, which is smaller; −1: a root. */
  readonly parent: number;
  /** The offset from the parent's joint, in the file's unit and axes. */
  readonly offset: Vec3;
  /** The channels in the order in which they are applied. */
  readonly channels: readonly BvhChannel[];
}

/** The contents of a BVH file, in its own unit and axes. */
export interface BvhMotion {
  readonly joints: readonly BvhJoint[];
  /** null: not stated. */
  readonly frameSeconds: number | null;
  readonly frameCount: number;
  /** The number of values of a frame. */
  readonly width: number;
  /** The values, frame after frame; angles in degrees. */
  readonly values: Float64Array;
  /** What was put right or assumed, a sentence each. */
  readonly notes: readonly string[];
}

/** The largest number of joints of a human skeleton. */
const maxJoints = 5000;
const linesPerStep = 64;

interface OpenJoint {
  readonly name: string;
  readonly parent: number;
  offset: Vec3;
  channels: readonly BvhChannel[];
}

function readOffset(lines: Lines, words: readonly Word[]): Vec3 {
  if (words.length !== 4) lines.fail(words[0]!.column, `OFFSET should be three numbers, has ${words.length - 1}`);
  const [x, y, z] = words.slice(1).map((word) => lines.numberOf(word));
  return vec3(x!, y!, z!);
}

function readChannels(lines: Lines, words: readonly Word[]): readonly BvhChannel[] {
  const [at, count, ...names] = words as [Word, Word | undefined, ...Word[]];
  if (!count || !/^\d+$/.test(count.word)) lines.fail(at.column, 'CHANNELS should begin with their count');
  if (Number(count.word) !== names.length)
    lines.fail(count.column, `CHANNELS ${shown(count.word)}, but ${names.length} follow`);
  return names.map(({ word, column }) => {
    const found = /^([xyz])(position|rotation)$/i.exec(word);
    if (!found) lines.fail(column, `channel ${shown(word)} is not known`);
    return {
      axis: found[1]!.toLowerCase() as Axis,
      kind: found[2]!.toLowerCase() as BvhChannel['kind'],
    };
  });
}

/** Splits the words of a line at braces: programs write them on the joint's line as well as on their own. */
function statementsOf(lines: Lines): readonly (readonly Word[])[] {
  const statements: Word[][] = [[]];
  for (const { word, column } of lines.words()) {
    let at = column;
    for (const part of word.split(/([{}])/)) {
      if (part === '{' || part === '}') statements.push([{ word: part, column: at }], []);
      else if (part !== '') statements.at(-1)!.push({ word: part, column: at });
      at += part.length;
    }
  }
  return statements.filter((words) => words.length > 0);
}

/** Reads the hierarchy, up to MOTION. */
function readHierarchy(lines: Lines): readonly OpenJoint[] {
  const joints: OpenJoint[] = [];
  const stack: number[] = [];
  let pending: string | null = null;
  const top = (column: number, what: string): OpenJoint => {
    const index = stack.at(-1);
    return index === undefined ? lines.fail(column, `${what} outside a joint`) : joints[index]!;
  };
  const read = (words: readonly Word[]): boolean => {
    const { word, column } = words[0]!;
    const keyword = word.toUpperCase();
    if (keyword === 'HIERARCHY') return false;
    if (keyword === 'ROOT' || keyword === 'JOINT') {
      pending = words.slice(1).map((part) => part.word).join(' '); // biome-ignore format: one thought
      if (pending === '') lines.fail(column, 'a joint without a name');
    } else if (keyword === 'END') {
      pending = `${top(column, 'End Site').name}:end`;
    } else if (keyword === '{') {
      if (pending === null) lines.fail(column, '“{” without a joint before it');
      if (joints.length >= maxJoints) lines.fail(column, `more than ${maxJoints} joints: not a human skeleton`);
      joints.push({ name: pending, parent: stack.at(-1) ?? -1, offset: vec3(0, 0, 0), channels: [] });
      stack.push(joints.length - 1);
      pending = null;
    } else if (keyword === '}') {
      if (stack.pop() === undefined) lines.fail(column, '“}” closes nothing');
    } else if (keyword === 'OFFSET') top(column, 'OFFSET').offset = readOffset(lines, words);
    else if (keyword === 'CHANNELS') top(column, 'CHANNELS').channels = readChannels(lines, words);
    else if (keyword === 'MOTION') {
      if (stack.length > 0)
        lines.fail(column, `the hierarchy is not closed before MOTION: ${stack.length} “}” missing`);
      if (joints.length === 0) lines.fail(column, 'no joint before MOTION');
      return true;
    } else lines.fail(column, `${shown(word)} is not known in a BVH hierarchy`);
    return false;
  };
  while (lines.next()) if (statementsOf(lines).some(read)) return joints;
  return lines.fail(1, joints.length === 0 ? 'no BVH file: no HIERARCHY' : 'the file ends before its MOTION');
}

interface Declared {
  count: number | null;
  seconds: number | null;
}

/** Reads “Frames: n” and “Frame Time: s”; false: the line is neither. */
function readDeclaration(lines: Lines, declared: Declared): boolean {
  const found = /^\s*(frames|frame\s+time)\s*:\s*(.*?)\s*$/i.exec(lines.line);
  if (!found) return false;
  const text = found[2]!;
  const column = lines.line.lastIndexOf(text === '' ? ':' : text) + 1;
  const value = text === '' ? Number.NaN : lines.parse(text);
  if (found[1]!.toLowerCase() === 'frames') {
    if (!Number.isSafeInteger(value) || value < 1) lines.fail(column, `Frames should be a count, is ${shown(text)}`);
    declared.count = value;
  } else {
    if (!(value >= 0)) lines.fail(column, `Frame Time should be seconds, is ${shown(text)}`);
    declared.seconds = value || null;
  }
  return true;
}

/**
 * Reads the text of a BVH file. Yields the fraction [0, 1] that was read. Throws a sentence with line and column where
 * the text is none: cut short, counts that do not agree, numbers that are none. A count of frames that is off by one
 * and a last row that is cut are put right.
 */
export function* readBvh(text: string): Generator<number, BvhMotion> {
  const lines = new Lines(text);
  const joints = readHierarchy(lines);
  const width = joints.reduce((sum, { channels }) => sum + channels.length, 0);
  if (width === 0) lines.fail(1, 'no joint of the hierarchy has channels: nothing moves');
  const declared: Declared = { count: null, seconds: null };
  const rows = new Rows(width);
  const notes: string[] = [];
  let cut: (() => never) | null = null;
  while (lines.next()) {
    cut?.();
    if (readDeclaration(lines, declared)) continue;
    if (declared.count !== null && rows.count > declared.count)
      lines.fail(1, `Frames says ${declared.count}, but more follow`);
    const at = rows.add();
    const count = lines.numbers(0, rows.values, at, width);
    if (count > width) lines.fail(1, `a frame has ${count} numbers, the hierarchy has ${width} channels`);
    if (count < width) {
      const { number } = lines;
      cut = () => {
        throw new Error(`line ${number}, column 1: a frame has ${count} numbers, the hierarchy has ${width} channels`);
      };
    }
    if (rows.count % linesPerStep === 0) yield lines.fraction;
  }
  if (cut) {
    // One row alone, or one too long, is no file that was cut at its end.
    if (rows.count < 2 || rows.count - 1 < (declared.count ?? 0) - 1) cut();
    rows.drop();
    notes.push('its last row is cut short; it was left out');
  }
  const frameCount = rows.count;
  if (frameCount === 0) lines.fail(1, 'the file ends without a frame');
  if (declared.count !== null && declared.count > frameCount + 1)
    lines.fail(1, `Frames says ${declared.count}, but the file ends after ${frameCount}`);
  if (declared.count !== null && declared.count !== frameCount)
    notes.push(`Frames says ${declared.count}, there are ${frameCount}; those were taken`);
  if (lines.commas) {
    if (/\d\.\d/.test(text.slice(text.search(/^\s*MOTION/im))))
      throw new Error('its numbers have both commas and points; write them with points');
    notes.push('its numbers have commas for decimals; they were read so');
  }
  const motion = { joints, frameSeconds: declared.seconds, frameCount, width, values: rows.finish(), notes };
  return withoutRepeatedPositions(motion);
}

/**
 * Marks position channels that are redundant: all zero on a joint that has an offset, or its offset again in every
 * frame. Constant positions of a joint without an offset are its offset.
 */
function withoutRepeatedPositions(motion: BvhMotion): BvhMotion {
  const { width, values, frameCount } = motion;
  const notes = [...motion.notes];
  let [zeros, column] = [0, 0];
  const joints = motion.joints.map((joint) => {
    const from = column;
    column += joint.channels.length;
    if (joint.parent < 0 || !joint.channels.some(({ kind }) => kind === 'position')) return joint;
    const { offset } = joint;
    const size = Math.max(Math.abs(offset.x), Math.abs(offset.y), Math.abs(offset.z));
    const first: Record<Axis, number> = { ...offset };
    let [zero, constant] = [true, true];
    for (const [i, { kind, axis }] of joint.channels.entries()) {
      if (kind !== 'position') continue;
      first[axis] = values[from + i]!;
      for (let frame = 0; frame < frameCount; frame++) {
        const value = values[frame * width + from + i]!;
        if (value !== 0) zero = false;
        if (Math.abs(value - first[axis]) > 1e-4 * size) constant = false;
      }
    }
    const repeats =
      constant && (['x', 'y', 'z'] as const).every((axis) => Math.abs(first[axis] - offset[axis]) <= 1e-3 * size);
    if (zero && size > 0) zeros += 1;
    const moved = constant && size === 0 && !zero;
    if (!(zero && size > 0) && !repeats && !moved) return joint;
    const channels = joint.channels.map(
      ({ kind, axis }) => ({ axis, kind: kind === 'position' ? 'unused' : kind }) as const,
    );
    return { ...joint, channels, offset: moved ? first : offset };
  });
  if (zeros > 0) notes.push(`the positions of ${zeros} joints are zero in every frame; their offsets were taken`);
  return { ...motion, joints, notes };
}

const turn = quat(0, 0, 0, 1);
const local = vec3(0, 0, 0);

/** Writes every joint of one frame. A position channel replaces the joint's offset. */
export function poseBvh({ joints, width, values }: BvhMotion, frame: number, target: SkeletonPose): SkeletonPose {
  let column = frame * width;
  for (const [i, { parent, offset, channels }] of joints.entries()) {
    const position = target.positions[i]!;
    const rotation = setQuat(target.rotations[i]!, 0, 0, 0, 1);
    copyVec3(offset, local);
    for (const { kind, axis } of channels) {
      const value = values[column++]!;
      if (kind === 'position') local[axis] = value;
      else if (kind === 'rotation')
        multiply(rotation, fromAxisAngle(unitAxes[axis], (value * Math.PI) / 180, turn), rotation);
    }
    if (parent < 0) copyVec3(local, position);
    else {
      const from = target.rotations[parent]!;
      add(target.positions[parent]!, rotate(from, local, position), position);
      multiply(from, rotation, rotation);
    }
  }
  return target;
}

/**
 * Returns a BVH file as an imported motion, whose angles are all zero at rest. `joints`: the corrected ones, if any.
 */
export function importedBvhMotion(motion: BvhMotion, joints = motion.joints, notes = motion.notes): ImportedMotion {
  const rest: Vec3[] = [];
  for (const { parent, offset } of joints) rest.push(parent < 0 ? zero : add(rest[parent]!, offset));
  const { frameCount, frameSeconds } = motion;
  const mended = { ...motion, joints };
  const names = joints.map(({ name }) => name);
  const parents = joints.map(({ parent }) => parent);
  return {
    ...{ names, parents, rest, frameCount, notes, rateHz: frameSeconds && 1 / frameSeconds },
    pose: (frame, target) => poseBvh(mended, frame, target),
  };
}
