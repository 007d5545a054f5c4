import { conjugate, identity, multiply, type Quat, rotate } from '../../../../src/threepoint/core/math/quat';
import { subtract, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import { createSkeletonPose, type ImportedMotion } from '../../../../src/threepoint/core/motion/imported-motion';
import { importedBvhMotion, readBvh } from '../../../../src/threepoint/core/motion/read-bvh';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { eulerYxz } from '../../../../src/threepoint/core/motion/write-bvh';

/** Reads the joints of a BVH. */
export const motionOf = (text: string): ImportedMotion => importedBvhMotion(finishWork(readBvh(text)));

export interface RerolledOptions {
  /** The rotation of a joint's local frame against the file's; absent: it stays. */
  readonly rollOf?: (name: string) => Quat;
  /** A rotation of the whole motion, as of other axes. */
  readonly turn?: Quat;
  /** Lengths of the file per length of the motion. */
  readonly unit?: number;
  readonly nameOf?: (name: string) => string;
  /** The frames that are written, from 0. */
  readonly frames?: readonly number[];
  readonly seconds?: number;
}

const degrees = ({ x, y, z }: Vec3): readonly number[] => [y, x, z].map((angle) => (angle * 180) / Math.PI);

/**
 * Returns a motion as a BVH whose joints have other local frames: no joint moves otherwise, and the pose in which all
 * angles are zero is another one.
 */
export function rerolledBvh(motion: ImportedMotion, options: RerolledOptions = {}): string {
  const { names, parents, rest } = motion;
  const { rollOf = () => identity, turn = identity, unit = 1, nameOf = (name) => name } = options;
  const rolls = names.map((name) => multiply(rollOf(name), conjugate(turn)));
  const ends = names.map((name) => name.endsWith(':end'));
  const text = (values: readonly number[]) => values.map((value) => value.toFixed(6)).join(' ');
  const lengths = (v: Vec3) => text([v.x * unit, v.y * unit, v.z * unit]);
  const order: number[] = [];
  const lines = (joint: number): string[] => {
    const parent = parents[joint]!;
    const offset = parent < 0 ? rest[joint]! : rotate(conjugate(rolls[parent]!), subtract(rest[joint]!, rest[parent]!));
    if (ends[joint]) return ['End Site', '{', `OFFSET ${lengths(offset)}`, '}'];
    order.push(joint);
    return [
      `${parent < 0 ? 'ROOT' : 'JOINT'} ${nameOf(names[joint]!)}`,
      '{',
      `OFFSET ${lengths(offset)}`,
      `CHANNELS ${parent < 0 ? '6 Xposition Yposition Zposition' : '3'} Yrotation Xrotation Zrotation`,
      ...names.flatMap((_, child) => (parents[child] === joint ? lines(child) : [])),
      '}',
    ];
  };
  const hierarchy = lines(0);
  const poses = createSkeletonPose(names.length);
  const frames = options.frames ?? Array.from({ length: motion.frameCount }, (_, frame) => frame);
  const rows = frames.map((frame) => {
    const { positions, rotations } = motion.pose(frame, poses);
    const rolled = rotations.map((rotation, i) => multiply(turn, multiply(rotation, rolls[i]!)));
    const angles = order.map((joint) => {
      const parent = parents[joint]!;
      const local = parent < 0 ? rolled[joint]! : multiply(conjugate(rolled[parent]!), rolled[joint]!);
      return text(degrees(eulerYxz(local, vec3(0, 0, 0))));
    });
    return [lengths(rotate(turn, positions[0]!)), ...angles].join(' ');
  });
  const seconds = options.seconds ?? 1 / (motion.rateHz ?? 60);
  return ['HIERARCHY', ...hierarchy, 'MOTION', `Frames: ${rows.length}`, `Frame Time: ${seconds}`, ...rows, ''].join(
    '\n',
  );
}
