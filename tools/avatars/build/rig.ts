import { type FingerName, fingerBoneSuffixes, skeletonFromCalibration } from 'threepoint/core';
import averageHand from '../../../src/threepoint/core/body/hand-geometry.json';
import { type JointName, parentOf } from '../../../src/threepoint/core/body/joints';
import type { Point } from './signed-distance';

/** A bone of the humanoid: its VRM name, its parent's, and where its joint is in T-pose [m], facing +Z, left = +X. */
export interface Bone {
  readonly name: string;
  readonly parent: string | null;
  readonly joint: Point;
}

/** What a rig is made to; all [m] but the size of the hand. */
export interface RigMeasures {
  /** How far out of the middle the shoulder joints lie; absent: as our skeleton has it. */
  readonly shoulder?: number;
  /** From shoulder to elbow, and from elbow to wrist; absent: as the average arm of 1.39 m of span. */
  readonly arm?: readonly [number, number];
  /** The scale of the average hand at this stature; absent: 1. */
  readonly hand?: number;
  /** The centre of the left eyeball; absent: the body has no eyes. */
  readonly eye?: Point;
}

/** A rig: its bones, parents before children, and the lines that the anatomy is drawn along. */
export interface BodyRig {
  readonly bones: readonly Bone[];
  /** Height of the straight arm and how far ahead of the middle it lies [m]. */
  readonly armHeight: number;
  readonly armDepth: number;
  /** x of shoulder, elbow, wrist [m]. */
  readonly armJoints: { readonly shoulder: number; readonly elbow: number; readonly wrist: number };
  /** Five separate fingers; the thumb lies forward and a little below, as in a hand at ease. */
  readonly fingers: readonly Finger[];
  /** Returns the position of finger joint `index` (0 to 3: knuckle to tip). */
  fingerPoint(finger: Finger, index: number): Point;
}

/** The body that rigs are modelled on: 1.70 m tall, with an arm as long as the anatomy draws it. */
const calibration = { eyeHeight: 1.59, armSpan: 1.39 };
const { restOffsets } = skeletonFromCalibration(calibration);

/** Our skeleton's hips lie behind the middle of the pelvis [m]: the eyes then come to lie where the face has them. */
const hipsBehind = 0.05;

/** A joint of our skeleton, which faces −Z, in the rig's T-pose, which faces +Z. */
function jointOf(name: JointName): Point {
  const parent = parentOf[name];
  const [x, y, z] = parent ? jointOf(parent) : [0, 0, -hipsBehind];
  const offset = restOffsets[name];
  return [x - offset.x, y + offset.y, z - offset.z];
}

const trunkNames = ['hips', 'spine', 'chest', 'upperChest', 'neck', 'head'] as const;
const trunk: Bone[] = trunkNames.map((name) => ({ name, parent: parentOf[name], joint: jointOf(name) }));

export interface Finger {
  readonly name: string;
  /** Knuckle in the left hand [m], z from the arm's own, lengths of its three phalanges [m], where it points. */
  readonly knuckle: Point;
  readonly lengths: readonly [number, number, number];
  readonly direction: Point;
  readonly radius: number;
}

export const unit = (x: number, y: number, z: number): Point => {
  const l = Math.hypot(x, y, z);
  return [x / l, y / l, z / l];
};

/** Height of the hip joints [m]: where the upper body ends. */
export const hipLine = 0.93;

const mirrored = (bone: Bone): Bone => ({
  name: bone.name.replace('left', 'right'),
  parent: bone.parent?.replace('left', 'right') ?? null,
  joint: [-bone.joint[0], bone.joint[1], bone.joint[2]],
});

/** A finger of the average hand (towards the thumb, up, ahead of the wrist), so much larger, in the rig's axes. */
function fingerOf(name: FingerName, wrist: Point, size: number): Finger {
  const { knuckle, direction, lengths, radius } = averageHand[name];
  const [out, above, ahead] = knuckle as [number, number, number];
  return {
    name: name[0]!.toUpperCase() + name.slice(1),
    knuckle: [wrist[0] + size * ahead, wrist[1] + size * above, size * out],
    lengths: lengths.map((length) => size * length) as [number, number, number],
    direction: unit(1, direction[1]!, direction[0]!),
    radius: size * radius,
  };
}

const legs: readonly Bone[] = [
  { name: 'leftUpperLeg', parent: 'hips', joint: [0.09, hipLine, -0.004] },
  { name: 'leftLowerLeg', parent: 'leftUpperLeg', joint: [0.096, 0.505, 0.004] },
  { name: 'leftFoot', parent: 'leftLowerLeg', joint: [0.098, 0.082, -0.022] },
  { name: 'leftToes', parent: 'leftFoot', joint: [0.104, 0.026, 0.108] },
];

export function makeRig({ shoulder, arm, hand = 1, eye }: RigMeasures = {}): BodyRig {
  const root = jointOf('leftShoulder');
  const average = jointOf('leftUpperArm');
  const [upper, lower] = arm ?? [
    jointOf('leftLowerArm')[0] - average[0],
    jointOf('leftHand')[0] - jointOf('leftLowerArm')[0],
  ];
  const [, armHeight, armDepth] = average;
  const armJoints = { shoulder: shoulder ?? average[0], elbow: 0, wrist: 0 };
  armJoints.elbow = armJoints.shoulder + upper;
  armJoints.wrist = armJoints.elbow + lower;
  const onArm = (x: number): Point => [x, armHeight, armDepth];
  const wrist = onArm(armJoints.wrist);
  const fingers = (['index', 'middle', 'ring', 'little', 'thumb'] as const).map((name) => fingerOf(name, wrist, hand));
  const fingerPoint = (finger: Finger, index: number): Point => {
    const length = finger.lengths.slice(0, index).reduce((sum, l) => sum + l, 0);
    const [dx, dy, dz] = finger.direction;
    // A hint of a curl: the further out, the lower.
    const sag = finger.name === 'Thumb' ? 0 : -0.45 * length * length;
    return [
      finger.knuckle[0] + dx * length,
      finger.knuckle[1] + dy * length + sag,
      armDepth + finger.knuckle[2] + dz * length,
    ];
  };
  const leftSide: Bone[] = [
    { name: 'leftShoulder', parent: parentOf.leftShoulder, joint: root },
    { name: 'leftUpperArm', parent: 'leftShoulder', joint: onArm(armJoints.shoulder) },
    { name: 'leftLowerArm', parent: 'leftUpperArm', joint: onArm(armJoints.elbow) },
    { name: 'leftHand', parent: 'leftLowerArm', joint: wrist },
    ...fingers.flatMap((finger) =>
      fingerBoneSuffixes(finger.name).map((phalanx, index) => ({
        name: `left${phalanx}`,
        parent: index === 0 ? 'leftHand' : `left${fingerBoneSuffixes(finger.name)[index - 1]}`,
        joint: fingerPoint(finger, index),
      })),
    ),
    ...legs,
    ...(eye ? [{ name: 'leftEye', parent: 'head', joint: eye }] : []),
  ];
  return {
    bones: [...trunk, ...leftSide, ...leftSide.map(mirrored)],
    armHeight,
    armDepth,
    armJoints,
    fingers,
    fingerPoint,
  };
}
