import { fromAxisAngle, multiply, quat, rotate, setQuat } from '../math/quat';
import { add, backward, copyVec3, right, up, type Vec3, vec3, zero } from '../math/vec3';
import type { FileMotion, JointPoses } from './file-motion';
import { Lines, Rows, shown, type Word } from './lines';

type Axis = 'x' | 'y' | 'z';
export interface BvhChannel {
  readonly kind: 'position' | 'rotation';
  readonly axis: Axis;
}

/** A joint of a file; an end site is a joint without channels, called “<parent>:end”. */
export interface BvhJoint {
  readonly name: string;
  /** Index of the parent, which is smaller; −1: a root. */
  readonly parent: number;
  /** From the parent's joint, in the file's unit and axes. */
  readonly offset: Vec3;
  /** In the order in which they are applied. */
  readonly channels: readonly BvhChannel[];
}

/** What a BVH file says, in its own unit and axes. */
export interface BvhMotion {
  readonly joints: readonly BvhJoint[];
  readonly frameSeconds: number;
  readonly frameCount: number;
  /** Numbers of a frame. */
  readonly width: number;
  /** Frame after frame; angles in degrees. */
  readonly values: Float64Array;
}

/** No skeleton of a person has as many. */
const mostJoints = 5000;
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

/** What stands before MOTION. */
function readHierarchy(lines: Lines): readonly OpenJoint[] {
  const joints: OpenJoint[] = [];
  const stack: number[] = [];
  let pending: string | null = null;
  const top = (column: number, what: string): OpenJoint => {
    const index = stack.at(-1);
    return index === undefined ? lines.fail(column, `${what} outside a joint`) : joints[index]!;
  };
  while (lines.next()) {
    const words = lines.words();
    const { word, column } = words[0]!;
    const keyword = word.toUpperCase();
    if (keyword === 'HIERARCHY') continue;
    if (keyword === 'ROOT' || keyword === 'JOINT') {
      pending = words.slice(1).map((part) => part.word).join(' '); // biome-ignore format: one thought
      if (pending === '') lines.fail(column, 'a joint without a name');
    } else if (keyword === 'END') {
      pending = `${top(column, 'End Site').name}:end`;
    } else if (keyword === '{') {
      if (pending === null) lines.fail(column, '“{” without a joint before it');
      if (joints.length >= mostJoints) lines.fail(column, `more than ${mostJoints} joints: not a human skeleton`);
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
      return joints;
    } else lines.fail(column, `${shown(word)} is not known in a BVH hierarchy`);
  }
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
  const value = text === '' ? Number.NaN : Number(text);
  if (found[1]!.toLowerCase() === 'frames') {
    if (!Number.isSafeInteger(value) || value < 1) lines.fail(column, `Frames should be a count, is ${shown(text)}`);
    declared.count = value;
  } else {
    if (!(Number.isFinite(value) && value > 0)) lines.fail(column, `Frame Time should be seconds, is ${shown(text)}`);
    declared.seconds = value;
  }
  return true;
}

/**
 * Reads the text of a BVH file. Yields the share [0, 1] that was read. Throws a sentence with line and column where the
 * text is none: cut short, counts that do not agree, numbers that are none.
 */
export function* readBvh(text: string): Generator<number, BvhMotion> {
  const lines = new Lines(text);
  const joints = readHierarchy(lines);
  const width = joints.reduce((sum, { channels }) => sum + channels.length, 0);
  if (width === 0) lines.fail(1, 'no joint of the hierarchy has channels: nothing moves');
  const declared: Declared = { count: null, seconds: null };
  const rows = new Rows(width);
  while (lines.next()) {
    if (readDeclaration(lines, declared)) continue;
    if (declared.count !== null && rows.count >= declared.count)
      lines.fail(1, `Frames says ${declared.count}, but more follow`);
    const at = rows.add();
    const count = lines.numbers(0, rows.values, at, width);
    if (count !== width) lines.fail(1, `a frame has ${count} numbers, the hierarchy has ${width} channels`);
    if (rows.count % linesPerStep === 0) yield lines.share;
  }
  const frameCount = rows.count;
  if (frameCount === 0) lines.fail(1, 'the file ends without a frame');
  if (declared.count !== null && declared.count !== frameCount)
    lines.fail(1, `Frames says ${declared.count}, but the file ends after ${frameCount}`);
  if (declared.seconds === null) throw new Error('a line “Frame Time: seconds” is needed, and there is none');
  return { joints, frameSeconds: declared.seconds, frameCount, width, values: rows.finish() };
}

const axes: Readonly<Record<Axis, Vec3>> = { x: right, y: up, z: backward };
const turn = quat(0, 0, 0, 1);
const local = vec3(0, 0, 0);

/** Every joint in one frame. A position that a file states takes the place of the joint's offset. */
export function poseBvh({ joints, width, values }: BvhMotion, frame: number, target: JointPoses): JointPoses {
  let column = frame * width;
  for (const [i, { parent, offset, channels }] of joints.entries()) {
    const position = target.positions[i]!;
    const rotation = setQuat(target.rotations[i]!, 0, 0, 0, 1);
    copyVec3(offset, local);
    for (const { kind, axis } of channels) {
      const value = values[column++]!;
      if (kind === 'position') local[axis] = value;
      else multiply(rotation, fromAxisAngle(axes[axis], (value * Math.PI) / 180, turn), rotation);
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
 * A BVH file as any file of motion: at rest all its angles are zero. `joints`: those of the file, or what was put right
 * of them.
 */
export function bvhFileMotion(motion: BvhMotion, joints = motion.joints, notes: readonly string[] = []): FileMotion {
  const rest: Vec3[] = [];
  for (const { parent, offset } of joints) rest.push(parent < 0 ? zero : add(rest[parent]!, offset));
  const { frameCount, frameSeconds } = motion;
  const mended = { ...motion, joints };
  const names = joints.map(({ name }) => name);
  return {
    ...{ names, rest, frameCount, notes, rateHz: 1 / frameSeconds },
    pose: (frame, target) => poseBvh(mended, frame, target),
  };
}
