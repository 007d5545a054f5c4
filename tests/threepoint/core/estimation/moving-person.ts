import type { Calibration } from '../../../../src/threepoint/core/body/calibration';
import { chestSpaceBody, sideSign } from '../../../../src/threepoint/core/body/skeleton';
import { type Frame, type TrackedPose, type Transform, transformPose } from '../../../../src/threepoint/core/math/pose';
import {
  fromAxes,
  fromAxisAngle,
  identity,
  multiply,
  type Quat,
  rotate,
} from '../../../../src/threepoint/core/math/quat';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import type { Side } from '../../../../src/threepoint/core/math/side';
import {
  add,
  addScaled,
  cross,
  normalise,
  right,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../../../../src/threepoint/core/math/vec3';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { fromEulerYxz } from '../euler-angles';

/** The initial position and yaw of a person on the floor. */
export interface Standpoint {
  readonly x: number;
  readonly z: number;
  readonly yaw: number;
}

export const tracked = (position: Vec3, orientation: Quat = identity): TrackedPose => ({
  ...{ position, orientation, tracking: 'tracked' },
});

/** The wrist's frame when the fingers point along `fingers` and the back of the hand along `back`. */
export function wristOrientation(fingers: Vec3, back: Vec3): Quat {
  const z = normalise(subtract(vec3(0, 0, 0), fingers));
  const x = normalise(cross(back, z), right);
  return fromAxes(x, cross(z, x), z);
}

/**
 * A person who leans, turns, crouches and moves the arms as a body of this calibration can: the frame at any time. Made
 * of sines of a seed, with its own simple body, so that it is no mirror image of what is tested.
 */
export function movingPerson(
  seed: number,
  calibration: Calibration,
  standpoint: Standpoint,
): (time: number) => TrackingFrame {
  const body = chestSpaceBody(calibration);
  const random = createRandom(seed);
  const wave = (amplitude: number): ((time: number) => number) => {
    const parts = [1, 2, 3].map(() => ({ rate: 0.3 + 3 * random(), phase: 7 * random() }));
    return (time) =>
      amplitude * parts.reduce((sum, { rate, phase }) => sum + Math.sin(rate * time + phase), 0) * Math.SQRT1_2;
  };
  const turning = wave(0.5);
  const [leanForward, leanSideways] = [wave(0.12), wave(0.07)];
  const [nod, look, tilt] = [wave(0.25), wave(0.4), wave(0.1)];
  const [driftX, driftZ, crouch] = [wave(0.1), wave(0.1), wave(0.04)];
  const arms = (['left', 'right'] as const).map((side) => ({
    side,
    swing: wave(0.5),
    out: wave(0.3),
    roll: wave(0.3),
    flexion: wave(0.4),
    turn: wave(0.4),
    bend: wave(0.25),
  }));

  return (time) => {
    const yaw = fromAxisAngle(up, standpoint.yaw + turning(time));
    const chest = multiply(yaw, fromEulerYxz(vec3(-0.1 + leanForward(time), 0, leanSideways(time))));
    const hips = vec3(
      standpoint.x + driftX(time),
      (0.6 - 0.03 - Math.abs(crouch(time))) * body.eyeHeight,
      standpoint.z + driftZ(time),
    );
    const neck = addScaled(hips, rotate(chest, up), body.lowerBack + body.thorax);
    const head = multiply(chest, fromEulerYxz(vec3(nod(time), look(time), tilt(time))));
    const headset = add(add(neck, rotate(chest, body.neckToHead)), rotate(head, body.eyesInHead));
    const hand = ({ side, swing, out, roll, flexion, turn, bend }: (typeof arms)[number]): TrackedPose => {
      const sigma = sideSign(side);
      const clavicle = add(body.clavicleRoot, body.clavicle);
      const shoulder = add(neck, rotate(chest, vec3(sigma * clavicle.x, clavicle.y, clavicle.z)));
      // The arm hangs along −Y; the elbow bends forward.
      const upper = multiply(
        chest,
        fromEulerYxz(vec3(0.6 + swing(time), -sigma * roll(time), sigma * (0.35 + out(time)))),
      );
      const elbow = addScaled(shoulder, rotate(upper, up), -body.armBones.upper);
      const forearm = multiply(upper, fromAxisAngle(right, 1.1 + 0.6 * Math.tanh(flexion(time))));
      const wrist = addScaled(elbow, rotate(forearm, up), -body.armBones.lower);
      const grip = wristOrientation(vec3(0, -1, 0), vec3(sigma, 0, 0));
      const wristTurn = fromEulerYxz(vec3(bend(time), sigma * bend(time + 1), turn(time)));
      return tracked(wrist, multiply(multiply(forearm, grip), wristTurn));
    };
    const [leftHand, rightHand] = arms.map(hand);
    return { time, head: tracked(headset, head), leftHand: leftHand!, rightHand: rightHand! };
  };
}

/** Returns the frame moved and turned as a whole. */
export function transformFrame(transform: Transform<Frame, Frame>, frame: TrackingFrame): TrackingFrame {
  const moved = (pose: TrackedPose): TrackedPose => ({
    ...(transformPose(transform, pose) as TrackedPose),
    tracking: pose.tracking,
  });
  return {
    time: frame.time,
    head: moved(frame.head),
    leftHand: frame.leftHand && moved(frame.leftHand),
    rightHand: frame.rightHand && moved(frame.rightHand),
  };
}

export const mirrorPoint = ({ x, y, z }: Vec3): Vec3 => vec3(-x, y, z);
export const mirrorRotation = ({ x, y, z, w }: Quat): Quat => ({ x, y: -y, z: -z, w });

/** Returns the frame mirrored on the plane x = 0: hands change sides. */
export function mirrorFrame(frame: TrackingFrame): TrackingFrame {
  const mirrored = (pose: TrackedPose): TrackedPose => ({
    position: mirrorPoint(pose.position),
    orientation: mirrorRotation(pose.orientation),
    tracking: pose.tracking,
  });
  return {
    time: frame.time,
    head: mirrored(frame.head),
    leftHand: frame.rightHand && mirrored(frame.rightHand),
    rightHand: frame.leftHand && mirrored(frame.leftHand),
  };
}

/** Returns the frame with another hand. */
export const withHand = (frame: TrackingFrame, side: Side, hand: TrackedPose | null): TrackingFrame =>
  side === 'left' ? { ...frame, leftHand: hand } : { ...frame, rightHand: hand };

/** A person at rest, upright, facing −Z, with the wrists there (floor frame), fingers away from the shoulder. */
export function standing(
  calibration: Calibration,
  leftWrist: Vec3,
  rightWrist: Vec3,
  time = 0,
): TrackingFrame & { readonly leftHand: TrackedPose; readonly rightHand: TrackedPose } {
  const shoulderHeight = 0.87 * calibration.eyeHeight;
  const hand = (wrist: Vec3, sigma: number) => {
    const fingers = normalise(subtract(wrist, vec3(sigma * 0.17, shoulderHeight, 0.05)));
    return tracked(wrist, wristOrientation(fingers, vec3(sigma, 0.3, 0)));
  };
  return {
    time,
    head: tracked(vec3(0, calibration.eyeHeight, 0), { x: 0, y: 0, z: 0, w: 1 }),
    leftHand: hand(leftWrist, -1),
    rightHand: hand(rightWrist, 1),
  };
}
