import fc from 'fast-check';
import { makeUpperBodyPose } from '../../../../src/threepoint/core/body/avatar-pose';
import { type Calibration, defaultCalibration } from '../../../../src/threepoint/core/body/calibration';
import { fingerBoneNames } from '../../../../src/threepoint/core/body/finger-bone-names';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import {
  averageHand,
  fingerPoints,
  makeFingerPoints,
  mirrorPoint,
} from '../../../../src/threepoint/core/body/hand-geometry';
import {
  closedHand,
  fingerNames,
  flatHand,
  type HandShape,
  lerpHandShape,
} from '../../../../src/threepoint/core/body/hand-shape';
import { jointNames } from '../../../../src/threepoint/core/body/joints';
import { skeletonFromCalibration, wristFromHandBone } from '../../../../src/threepoint/core/body/skeleton';
import { createIk } from '../../../../src/threepoint/core/estimation/estimators';
import type { TrackedPose } from '../../../../src/threepoint/core/math/pose';
import {
  conjugate,
  copyQuat,
  fromAxisAngle,
  multiply,
  type Quat,
  rotate,
} from '../../../../src/threepoint/core/math/quat';
import { add, copyVec3, up, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import type { Motion } from '../../../../src/threepoint/core/motion/motion';
import { MotionTaker } from '../../../../src/threepoint/core/motion/take-motion';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { actorFrame } from '../../../../src/threepoint/core/tracking/actor-motion';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { rotation, seed } from '../arbitraries';

export const rateHz = 72;
export const person: Calibration = defaultCalibration;
const skeleton = skeletonFromCalibration(person);
const sides = ['left', 'right'] as const;

/** The joints' positions and rotations, floor frame; ends such as finger tips have a position only. */
export type Truth = ReadonlyMap<string, { readonly position: Vec3; readonly orientation: Quat | null }>;

/** A motion, and of each of its frames the joints as kinematics has them, computed without it. */
export interface MovedPerson {
  readonly motion: Motion;
  readonly truth: readonly Truth[];
}

const still: TrackedPose = { position: vec3(0, 1.6, 0), orientation: { x: 0, y: 0, z: 0, w: 1 }, tracking: 'tracked' };

function joints(
  body: { hipsPosition: Vec3; localRotations: Parameters<typeof forwardKinematics>[1]['localRotations'] },
  shapes: Record<'left' | 'right', HandShape>,
): Truth {
  const found = new Map<string, { position: Vec3; orientation: Quat | null }>();
  const posed = forwardKinematics(skeleton, body);
  for (const name of jointNames) {
    const { position, orientation } = posed[name];
    found.set(name, { position: copyVec3(position), orientation: copyQuat(orientation) });
  }
  const hand = averageHand(person.eyeHeight);
  for (const side of sides) {
    const { position, orientation } = posed[`${side}Hand`];
    const wrist = multiply(orientation, conjugate(wristFromHandBone[side]));
    for (const finger of fingerNames) {
      const points = fingerPoints(finger, hand[finger], shapes[side][finger], makeFingerPoints());
      const names = [...fingerBoneNames(side, finger), `${fingerBoneNames(side, finger)[2]}:end`];
      for (const [i, point] of points.entries()) {
        const inWrist = side === 'left' ? point : mirrorPoint(point, vec3(0, 0, 0));
        found.set(names[i]!, { position: add(position, rotate(wrist, inWrist)), orientation: null });
      }
    }
  }
  return found;
}

/** Any rotations of any joints, quarter and half turns among them, and any fingers: what no estimator would draw. */
export function contortedPerson(count = 40): MovedPerson {
  const taker = new MotionTaker(person, count, rateHz);
  const turns = fc.sample(fc.tuple(...jointNames.map(() => rotation)), { numRuns: count, seed });
  const bends = fc.sample(fc.double({ min: 0, max: 1, noNaN: true }), { numRuns: 2 * count, seed });
  const truth = turns.map((rotations, i) => {
    const body = makeUpperBodyPose();
    body.hipsPosition.x = i / 10 - 2;
    body.hipsPosition.y = 0.9;
    body.hipsPosition.z = 1.5 - i / 20;
    for (const [j, name] of jointNames.entries()) copyQuat(rotations[j]!, body.localRotations[name]);
    const shape = (at: number) => ({ ...lerpHandShape(flatHand, closedHand, bends[at]!), pinch: 0 });
    const shapes = { left: shape(2 * i), right: shape(2 * i + 1) };
    const frame: TrackingFrame = {
      time: 100 + i / rateHz,
      head: still,
      leftHand: null,
      rightHand: still,
      fingers: shapes,
    };
    taker.add(frame, { head: still, leftHand: null, rightHand: still, body });
    return joints(body, shapes);
  });
  return { motion: taker.finish(), truth };
}

/** The actor as inverse kinematics draws it, somewhere in the room and turned, with fingers that open and close. */
export function actingPerson(seconds = 4): MovedPerson {
  const count = seconds * rateHz;
  const taker = new MotionTaker(person, count, rateHz);
  const estimator = createIk(person);
  const turn = fromAxisAngle(up, 2.3);
  const place = (pose: TrackedPose | null): TrackedPose | null =>
    pose && {
      ...pose,
      position: add(rotate(turn, pose.position), vec3(1.2, 0, -0.7)),
      orientation: multiply(turn, pose.orientation),
    };
  const truth: Truth[] = [];
  for (let i = 0; i < count; i++) {
    const acted = actorFrame(3 + i / rateHz, person);
    const shape = { ...lerpHandShape(flatHand, closedHand, 0.5 - 0.5 * Math.cos(i / 20)), pinch: 0 };
    const shapes = { left: shape, right: shape };
    const frame = {
      ...acted,
      head: place(acted.head)!,
      leftHand: place(acted.leftHand),
      rightHand: place(acted.rightHand),
      fingers: shapes,
    };
    const { pose } = estimator.update(frame);
    if (!pose.body) throw new Error('inverse kinematics draws a body');
    taker.add(frame, pose);
    truth.push(joints(pose.body, shapes));
  }
  return { motion: taker.finish(), truth };
}

/** The first frames of a motion. */
export const firstFrames = (motion: Motion, count: number): Motion => ({
  ...motion,
  times: motion.times.slice(0, count),
  hips: motion.hips.slice(0, 3 * count),
  rotations: motion.rotations.slice(0, 4 * motion.measured * count),
  seen: motion.seen.slice(0, count),
});
/** The text of parts that work makes. */
export const textOf = (work: Generator<number, readonly string[]>): string => finishWork(work).join('');

/** The bytes of parts that work makes. */
export const bytesOf = (work: Generator<number, readonly Uint8Array[]>): Uint8Array<ArrayBuffer> =>
  new Uint8Array(Buffer.concat(finishWork(work)));
