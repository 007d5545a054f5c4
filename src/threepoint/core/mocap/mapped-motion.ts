import { conjugate, fromAxisAngle, multiply, type Quat, rotate } from '../math/quat';
import { subtract, up, type Vec3 } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion, type SkeletonPose } from '../motion/imported-motion';
import { type BvhJoint, type BvhMotion, poseBvh } from '../motion/read-bvh';
import { floorFromAxes } from './body-axes';
import { directions } from './read-skeleton-map';
import type { SkeletonMap } from './skeleton-map';

/** Returns the rotation from a file's axes to those of the floor (+Y up, people at rest face −Z). */
export const floorFromFile = ({ up: upward = '+y', forward = '+z' }: SkeletonMap): Quat =>
  floorFromAxes(directions[upward], directions[forward]);

/** Returns the motion relative to another rest pose. */
export function withRestPose(file: ImportedMotion, { positions, rotations }: SkeletonPose): ImportedMotion {
  const backs = rotations.map((rotation) => conjugate(rotation));
  return {
    ...file,
    rest: positions.map((position) => subtract(position, positions[0]!)),
    pose(frame, target) {
      file.pose(frame, target);
      for (const [i, back] of backs.entries()) multiply(target.rotations[i]!, back, target.rotations[i]!);
      return target;
    },
  };
}

/**
 * Returns the motion relative to a rest pose that faces forward: a T-pose from a frame or from angles may be turned.
 */
function facingForward(file: ImportedMotion, map: SkeletonMap): ImportedMotion {
  const floor = floorFromFile(map);
  const restOf = (joint: 'leftUpperArm' | 'rightUpperArm'): Vec3 => file.rest[file.names.indexOf(map.joints[joint]!)]!;
  const across = rotate(floor, subtract(restOf('rightUpperArm'), restOf('leftUpperArm')));
  const ours = fromAxisAngle(up, -Math.atan2(-across.z, across.x));
  const turn = multiply(conjugate(floor), multiply(ours, floor));
  const turned = createSkeletonPose(file.names.length);
  for (const [i, at] of file.rest.entries()) rotate(turn, at, turned.positions[i]!);
  for (const rotation of turned.rotations) Object.assign(rotation, turn);
  return withRestPose(file, turned);
}

/**
 * Returns the motion relative to the T-pose of a map, facing forward; unchanged where the map has none. Throws a
 * sentence where the T-pose does not match the file.
 */
export function fromMappedRest(
  file: ImportedMotion,
  map: SkeletonMap,
  bvh: { readonly motion: BvhMotion; readonly joints: readonly BvhJoint[] } | null,
  restFile: ImportedMotion = file,
): ImportedMotion {
  const { restFrame, restPose } = map;
  const demand = (joints: Readonly<Record<string, string>>, what: string) => {
    for (const [ours, theirs] of Object.entries(joints))
      if (!file.names.includes(theirs))
        throw new Error(`no joint “${theirs}”, which the map “${map.name}” names as ${what}${ours}`);
  };
  demand(map.joints, '');
  demand(map.rotations ?? {}, 'the rotation of ');
  if (restPose) {
    if (!bvh) throw new Error('restPose is for BVH files; here restFrame can be given');
    return facingForward(withRestPose(file, poseOfAngles(bvh.motion, bvh.joints, restPose)), map);
  }
  if (restFrame === undefined) return file;
  if (restFrame > restFile.frameCount)
    throw new Error(`restFrame ${restFrame}, but there are ${restFile.frameCount} frames`);
  const there = restFile.pose(restFrame - 1, createSkeletonPose(restFile.names.length));
  const order = file.names.map((name) => restFile.names.indexOf(name));
  const missing = order.indexOf(-1);
  if (missing >= 0) throw new Error(`no joint “${file.names[missing]}”, so its restFrame is of another skeleton`);
  const pose = { positions: order.map((i) => there.positions[i]!), rotations: order.map((i) => there.rotations[i]!) };
  return facingForward(withRestPose(file, pose), map);
}

/** Returns the joints at these angles [degrees]: the root at the origin, others at their offsets, missing angles 0. */
function poseOfAngles(
  motion: BvhMotion,
  joints: readonly BvhJoint[],
  angles: NonNullable<SkeletonMap['restPose']>,
): SkeletonPose {
  for (const name of Object.keys(angles))
    if (!joints.some((joint) => joint.name === name))
      throw new Error(`no joint “${name}”, which the map's restPose turns`);
  const values = joints.flatMap(({ name, parent, offset, channels }) => {
    const given = angles[name] ?? [];
    const turning = channels.filter(({ kind }) => kind === 'rotation').length;
    if (given.length > 0 && given.length !== turning)
      throw new Error(`restPose gives ${name} ${given.length} angles, the file ${turning} rotation channels`);
    let next = 0;
    return channels.map(({ kind, axis }) => {
      if (kind !== 'rotation') return parent < 0 ? 0 : offset[axis];
      next += 1;
      return given[next - 1] ?? 0;
    });
  });
  const pose = { ...motion, joints, frameCount: 1, values: Float64Array.from(values) };
  return poseBvh(pose, 0, createSkeletonPose(joints.length));
}
