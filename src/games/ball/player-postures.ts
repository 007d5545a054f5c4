import { allReleased, type HandButtons, recordOf, sideSign } from 'threepoint/core';
import {
  add,
  clamp,
  copyQuat,
  copyVec3,
  fromAxisAngle,
  invertTransform,
  lerp,
  type MutableQuat,
  type MutableVec3,
  makeTrackedPose,
  multiply,
  normalise,
  type Quat,
  quat,
  right,
  type Side,
  sides,
  slerp,
  subtract,
  type TrackedPose,
  type Transform,
  transformPoint,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { wristAround } from '../fist';
import { armRatio, halfShoulderRatio, shoulderBehindRatio, shoulderDropRatio, swayAt, yawOf } from '../simulated-body';
import type { SimulatedInput } from '../simulated-input';

/** The body and the station of a player. */
export interface PlayerBody {
  /** Height of the eyes above the floor [m], standing or seated. */
  readonly eyeHeight: number;
  /** Shoulder to wrist [m]. Default: the average for a standing person with this eye height. */
  readonly armLength?: number;
  readonly arenaFromFloor: Transform<'arena', 'floor'>;
}

/** Position and directions of a fist, floor frame. */
interface Grasp {
  readonly fist: Vec3;
  readonly knuckles: Vec3;
  readonly thumb: Vec3;
}

/** Head and fists at one moment, floor frame. */
export interface PlayerPosture {
  readonly eyes: Vec3;
  readonly gaze: Quat;
  readonly left: Grasp;
  readonly right: Grasp;
}

/** A grasp that its owner overwrites. */
export interface MutableGrasp extends Grasp {
  readonly fist: MutableVec3;
  readonly knuckles: MutableVec3;
  readonly thumb: MutableVec3;
}

/** A posture that its owner overwrites. */
export interface MutablePosture extends PlayerPosture {
  readonly eyes: MutableVec3;
  readonly gaze: MutableQuat;
  readonly left: MutableGrasp;
  readonly right: MutableGrasp;
}

const makeGrasp = (): MutableGrasp => ({ fist: vec3(0, 0, 0), knuckles: vec3(0, 0, 0), thumb: vec3(0, 0, 0) });

export const makePosture = (): MutablePosture => ({
  eyes: vec3(0, 0, 0),
  gaze: quat(0, 0, 0, 1),
  left: makeGrasp(),
  right: makeGrasp(),
});

function copyGrasp({ fist, knuckles, thumb }: Grasp, target: MutableGrasp): void {
  copyVec3(fist, target.fist);
  copyVec3(knuckles, target.knuckles);
  copyVec3(thumb, target.thumb);
}

export function copyPosture(posture: PlayerPosture, target: MutablePosture = makePosture()): MutablePosture {
  copyVec3(posture.eyes, target.eyes);
  copyQuat(posture.gaze, target.gaze);
  copyGrasp(posture.left, target.left);
  copyGrasp(posture.right, target.right);
  return target;
}

/** Limits of the head's yaw and pitch [rad]. */
const maxYaw = 0.8;
const maxPitch = 0.6;

function mixGrasp(a: Grasp, b: Grasp, share: number, target: MutableGrasp): void {
  lerp(a.fist, b.fist, share, target.fist);
  normalise(lerp(a.knuckles, b.knuckles, share, target.knuckles), undefined, target.knuckles);
  normalise(lerp(a.thumb, b.thumb, share, target.thumb), undefined, target.thumb);
}

/** Interpolates between two postures, floor frame. */
export function mixPostures(
  a: PlayerPosture,
  b: PlayerPosture,
  share: number,
  target: MutablePosture = makePosture(),
): MutablePosture {
  lerp(a.eyes, b.eyes, share, target.eyes);
  slerp(a.gaze, b.gaze, share, target.gaze);
  mixGrasp(a.left, b.left, share, target.left);
  mixGrasp(a.right, b.right, share, target.right);
  return target;
}

/** Directions of a hanging hand, far enough from the thigh for a ball. */
const hangingKnuckles = normalise(vec3(0, -1, -0.25));
const hangingThumb = { left: normalise(vec3(-0.2 * -1, 0, -1)), right: normalise(vec3(-0.2, 0, -1)) };

const sight = vec3(0, 0, 0);
const nod = quat(0, 0, 0, 1);
const drift = vec3(0, 0, 0);
const drifted = vec3(0, 0, 0);

/**
 * Building blocks for the postures of throwers and holders. Creates the postures of a body that faces −Z of its floor
 * frame.
 */
export function createPlayerPostures({ eyeHeight, arenaFromFloor, armLength = armRatio * eyeHeight }: PlayerBody) {
  const arm = armLength;
  const floorFromArena = invertTransform(arenaFromFloor);
  const half = (halfShoulderRatio / armRatio) * arm;
  const fromEyes = recordOf(sides, (side) =>
    vec3(sideSign(side) * half, -shoulderDropRatio * arm, shoulderBehindRatio * arm),
  );
  const hanging = recordOf(sides, (side) => vec3(sideSign(side) * 0.27 * arm, -1.01 * arm, -0.2 * arm));
  const shoulder = (side: Side, eyes: Vec3, target?: MutableVec3): MutableVec3 => add(eyes, fromEyes[side], target);

  function wrist(side: Side, { fist, knuckles, thumb }: Grasp): TrackedPose {
    const pose = makeTrackedPose();
    wristAround<'floor'>(side, add(fist, drift, drifted), knuckles, thumb, pose);
    return pose;
  }

  const pressing = (pressure: number): HandButtons => ({ ...allReleased, trigger: pressure });

  return {
    /** Shoulder to wrist [m]. */
    arm,
    /** The eyes of an upright player at the station, floor frame. */
    eyes: vec3(0, eyeHeight, 0),
    inFloor: (point: Vec3, target?: MutableVec3): MutableVec3 => transformPoint(floorFromArena, point, target),
    /** Returns a shoulder for these eyes of a player that faces −Z. */
    shoulder,
    /** Returns the gaze from the eyes to a point. */
    gazeAt(eyes: Vec3, at: Vec3, target?: MutableQuat): MutableQuat {
      const { x, y, z } = subtract(at, eyes, sight);
      // The head turns only within its limits; the eyes would do the rest.
      const yaw = clamp(yawOf(sight), -maxYaw, maxYaw);
      const pitch = clamp(Math.atan2(y, Math.hypot(x, z)), -maxPitch, maxPitch);
      const turn = fromAxisAngle(up, yaw, target);
      return multiply(turn, fromAxisAngle(right, pitch, nod), turn);
    },
    hang(side: Side, eyes: Vec3, target: MutableGrasp): void {
      add(shoulder(side, eyes, target.fist), hanging[side], target.fist);
      copyVec3(hangingKnuckles, target.knuckles);
      copyVec3(hangingThumb[side], target.thumb);
    },
    /** Returns head, hands and buttons of a posture at a time [s], with postural sway; pressures in [0, 1]. */
    inputFor(posture: PlayerPosture, time: number, leftPressure: number, rightPressure: number): SimulatedInput {
      swayAt(time, drift);
      const head = makeTrackedPose();
      add(posture.eyes, drift, head.position);
      copyQuat(posture.gaze, head.orientation);
      const leftHand = wrist('left', posture.left);
      const rightHand = wrist('right', posture.right);
      return {
        frame: { time, head, leftHand, rightHand },
        buttons: { left: pressing(leftPressure), right: pressing(rightPressure) },
      };
    },
  };
}

export type PlayerPostures = ReturnType<typeof createPlayerPostures>;
