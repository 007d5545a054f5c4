import { clamp } from '../../math/damper';
import { invertTransform, type Pose, type TrackedPose, type Transform, transformPoint } from '../../math/pose';
import { fromAxisAngle, multiply, type Quat, slerp } from '../../math/quat';
import type { Side } from '../../math/side';
import { add, lerp, normalise, subtract, up, type Vec3, vec3 } from '../../math/vec3';
import type { TrackingFrame } from '../../tracking/tracking-frame';
import { allReleased, type Button, type Buttons } from '../button-presses';
import { wristAround } from '../fist';
import { armShare, shoulderBehind, shoulderDrop, shoulderShare, yawOf } from '../posture';

/** Who plays, and where. */
export interface PlayerBody {
  /** Height of the eyes above the floor [m], standing or seated as the player is. */
  readonly eyeHeight: number;
  /** Shoulder to wrist [m]. Default: that of somebody who stands with eyes at this height. */
  readonly armLength?: number;
  readonly arenaFromFloor: Transform<'arena', 'floor'>;
  /** The button that takes and throws. */
  readonly button?: Button;
}

/** Where a fist is and how it is turned, floor frame. */
export interface Grasp {
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

/** Somebody who plays without a person, as a headset and two hands see it. */
export interface Performed {
  readonly frame: TrackingFrame;
  readonly buttons: Buttons;
}

/** A head turns and nods this far [rad]. */
const mostYaw = 0.8;
const mostPitch = 0.6;

const mixGrasp = (a: Grasp, b: Grasp, share: number): Grasp => ({
  fist: lerp(a.fist, b.fist, share),
  knuckles: normalise(lerp(a.knuckles, b.knuckles, share)),
  thumb: normalise(lerp(a.thumb, b.thumb, share)),
});

/** On the way from one posture to another, floor frame. */
export const mixPostures = (a: PlayerPosture, b: PlayerPosture, share: number): PlayerPosture => ({
  eyes: lerp(a.eyes, b.eyes, share),
  gaze: slerp(a.gaze, b.gaze, share),
  left: mixGrasp(a.left, b.left, share),
  right: mixGrasp(a.right, b.right, share),
});

/** What the postures of throwers and holders are made of. */
export interface PlayerPostures {
  /** Shoulder to wrist [m]. */
  readonly arm: number;
  /** Of the eyes of somebody who stands upright on the mark, floor frame. */
  readonly eyes: Vec3;
  inFloor(pointInArena: Vec3): Vec3;
  /** A shoulder of somebody who faces −Z with the eyes there. */
  shoulder(side: Side, eyes: Vec3): Vec3;
  /** The gaze at a point from the eyes. */
  looking(eyes: Vec3, at: Vec3): Quat;
  /** A hand that hangs. */
  hanging(side: Side, eyes: Vec3): Grasp;
  /** Nobody stands still: the posture as a headset and two hands see it at a time [s], fists' pressures 0 to 1. */
  seen(posture: PlayerPosture, time: number, pressures: Readonly<Record<Side, number>>): Performed;
}

/** How somebody of this body stands at their station, facing −Z of their floor. */
export function createPlayerPostures({
  eyeHeight,
  arenaFromFloor,
  armLength = armShare * eyeHeight,
  button = 'trigger',
}: PlayerBody): PlayerPostures {
  const arm = armLength;
  const floorFromArena = invertTransform(arenaFromFloor);
  const half = (shoulderShare / armShare) * arm;
  const sigma = (side: Side) => (side === 'left' ? -1 : 1);
  const shoulder = (side: Side, eyes: Vec3): Vec3 =>
    add(eyes, vec3(sigma(side) * half, -shoulderDrop * arm, shoulderBehind * arm));
  return {
    arm,
    eyes: vec3(0, eyeHeight, 0),
    inFloor: (point) => transformPoint(floorFromArena, point),
    shoulder,
    looking(eyes, at) {
      const { x, y, z } = subtract(at, eyes);
      // Eyes do the rest: nobody turns the head over the shoulder to find a ball that lies beside them.
      const yaw = clamp(yawOf(vec3(x, 0, z)), -mostYaw, mostYaw);
      const pitch = clamp(Math.atan2(y, Math.hypot(x, z)), -mostPitch, mostPitch);
      return multiply(fromAxisAngle(up, yaw), fromAxisAngle(vec3(1, 0, 0), pitch));
    },
    hanging: (side, eyes) => ({
      fist: add(shoulder(side, eyes), vec3(sigma(side) * 0.22 * arm, -1.02 * arm, -0.2 * arm)),
      knuckles: normalise(vec3(0, -1, -0.25)),
      thumb: normalise(vec3(-0.2 * sigma(side), 0, -1)),
    }),
    seen(posture, time, pressures) {
      const drift = vec3(
        0.006 * Math.sin(time * 0.61),
        0.002 * Math.sin(time * 1.5),
        0.005 * Math.sin(time * 0.43 + 1),
      );
      const wrist = (side: Side): TrackedPose => {
        const { fist, knuckles, thumb } = posture[side];
        const held: Pose<'floor'> = wristAround(side, add(fist, drift), knuckles, thumb);
        return { ...held, tracking: 'tracked' };
      };
      return {
        frame: {
          time,
          head: { position: add(posture.eyes, drift), orientation: posture.gaze, tracking: 'tracked' },
          leftHand: wrist('left'),
          rightHand: wrist('right'),
        },
        buttons: {
          left: { ...allReleased, [button]: pressures.left },
          right: { ...allReleased, [button]: pressures.right },
        },
      };
    },
  };
}
