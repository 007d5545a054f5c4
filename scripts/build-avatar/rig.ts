import { fingerBones } from '../../src/core/body/finger-bones';
import averageHand from '../../src/core/body/hand-geometry.json';
import type { FingerName } from '../../src/core/body/hand-shape';
import { type JointName, parentOf } from '../../src/core/body/joints';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import type { Point } from './signed-distance';

/** A bone of the humanoid: its VRM name, its parent's, and where its joint is in T-pose [m], facing +Z, left = +X. */
export interface Bone {
  readonly name: string;
  readonly parent: string | null;
  readonly joint: Point;
}

/** The body that the mannequin is modelled on: 1.70 m tall, with an arm as long as the anatomy below draws it. */
const calibration = { eyeHeight: 1.59, armSpan: 1.39 };
const { restOffsets } = skeletonFromCalibration(calibration);

/** Our skeleton's hips lie behind the middle of the pelvis [m]: the eyes then come to lie where the face has them. */
const hipsBehind = 0.05;

/** A joint of our skeleton, which faces −Z, in the mannequin's T-pose, which faces +Z. */
function jointOf(name: JointName): Point {
  const parent = parentOf[name];
  const [x, y, z] = parent ? jointOf(parent) : [0, 0, -hipsBehind];
  const offset = restOffsets[name];
  return [x - offset.x, y + offset.y, z - offset.z];
}

const shoulderJoint = jointOf('leftUpperArm');
/** Height of the straight arm and how far ahead of the middle it lies [m]. */
export const armHeight = shoulderJoint[1];
export const armDepth = shoulderJoint[2];
/** x of shoulder, elbow, wrist [m]. */
export const armJoints = {
  shoulder: shoulderJoint[0],
  elbow: jointOf('leftLowerArm')[0],
  wrist: jointOf('leftHand')[0],
};

const trunkNames = ['hips', 'spine', 'chest', 'upperChest', 'neck', 'head'] as const;
const trunk: Bone[] = trunkNames.map((name) => ({ name, parent: parentOf[name], joint: jointOf(name) }));

interface Finger {
  readonly name: string;
  /** Knuckle in the left hand [m], z from the arm's own, lengths of its three phalanges [m], where it points. */
  readonly knuckle: Point;
  readonly lengths: readonly [number, number, number];
  readonly direction: Point;
  readonly radius: number;
}

const unit = (x: number, y: number, z: number): Point => {
  const l = Math.hypot(x, y, z);
  return [x / l, y / l, z / l];
};

/** A finger of the average hand (towards the thumb, up, ahead of the wrist), in the mannequin's axes. */
function fingerOf(name: FingerName): Finger {
  const { knuckle, direction, lengths, radius } = averageHand[name];
  const [out, above, ahead] = knuckle as [number, number, number];
  return {
    name: name[0]!.toUpperCase() + name.slice(1),
    knuckle: [armJoints.wrist + ahead, armHeight + above, out],
    lengths: lengths as [number, number, number],
    direction: unit(1, direction[1]!, direction[0]!),
    radius,
  };
}

/** Five separate fingers; the thumb lies forward and a little below, as in a hand at ease. */
export const fingers: readonly Finger[] = (['index', 'middle', 'ring', 'little', 'thumb'] as const).map(fingerOf);

/** Where along a finger joint `index` (0 to 3: knuckle to tip) lies. */
export function fingerPoint(finger: Finger, index: number): Point {
  const length = finger.lengths.slice(0, index).reduce((sum, l) => sum + l, 0);
  const [dx, dy, dz] = finger.direction;
  // A hint of a curl: the further out, the lower.
  const sag = finger.name === 'Thumb' ? 0 : -0.45 * length * length;
  return [
    finger.knuckle[0] + dx * length,
    finger.knuckle[1] + dy * length + sag,
    armDepth + finger.knuckle[2] + dz * length,
  ];
}

/** Height of the hip joints [m]: where the upper body ends. */
export const hipLine = 0.93;

const leftSide: Bone[] = [
  ...(['leftShoulder', 'leftUpperArm', 'leftLowerArm', 'leftHand'] as const).map((name) => ({
    name,
    parent: parentOf[name],
    joint: jointOf(name),
  })),
  ...fingers.flatMap((finger) =>
    fingerBones(finger.name).map((phalanx, index) => ({
      name: `left${phalanx}`,
      parent: index === 0 ? 'leftHand' : `left${fingerBones(finger.name)[index - 1]}`,
      joint: fingerPoint(finger, index),
    })),
  ),
  { name: 'leftUpperLeg', parent: 'hips', joint: [0.09, hipLine, -0.004] },
  { name: 'leftLowerLeg', parent: 'leftUpperLeg', joint: [0.096, 0.505, 0.004] },
  { name: 'leftFoot', parent: 'leftLowerLeg', joint: [0.098, 0.082, -0.022] },
  { name: 'leftToes', parent: 'leftFoot', joint: [0.104, 0.026, 0.108] },
];

const mirrored = (bone: Bone): Bone => ({
  name: bone.name.replace('left', 'right'),
  parent: bone.parent?.replace('left', 'right') ?? null,
  joint: [-bone.joint[0], bone.joint[1], bone.joint[2]],
});

/** The whole rig, parents before children. */
export const bones: readonly Bone[] = [...trunk, ...leftSide, ...leftSide.map(mirrored)];
