import type { JointName } from '../body/joints';
import { allFinite } from '../math/all-finite';
import { sides } from '../math/side';
import { type MutableVec3, readVec3 } from '../math/vec3';

/**
 * The joints of WebXR Body Tracking that are used, in the specification's order: all except those within a hand,
 * because frames have fingers.
 */
export const deviceJointNames: readonly string[] = [
  ...['hips', 'spine-lower', 'spine-middle', 'spine-upper', 'chest', 'neck', 'head'],
  ...sides.flatMap((side) =>
    ['shoulder', 'scapula', 'arm-upper', 'arm-lower', 'hand-wrist-twist'].map((joint) => `${side}-${joint}`),
  ),
  ...sides.flatMap((side) => ['hand-palm', 'hand-wrist'].map((joint) => `${side}-${joint}`)),
  ...sides.flatMap((side) =>
    ['upper-leg', 'lower-leg', 'foot-ankle-twist', 'foot-ankle', 'foot-subtalar', 'foot-transverse', 'foot-ball'].map(
      (joint) => `${side}-${joint}`,
    ),
  ),
];

/** The joints that a device reports: x, y, z of each of `deviceJointNames` [m], floor frame, finite. */
export type DeviceBody = Float32Array;

/** The length of a DeviceBody. */
export const deviceBodySize = 3 * deviceJointNames.length;

/** Returns whether the array has a finite position for every joint. */
export const isFiniteDeviceBody = (body: DeviceBody): boolean => body.length === deviceBodySize && allFinite(body);

const named = (joint: string): number => 3 * deviceJointNames.indexOf(joint);

/**
 * The index in a DeviceBody of each joint of the skeleton that devices report. The skeleton's `chest` is a device's
 * `spine-upper`.
 */
const places = {
  hips: named('hips'),
  chest: named('spine-upper'),
  neck: named('neck'),
  head: named('head'),
  leftUpperArm: named('left-arm-upper'),
  leftLowerArm: named('left-arm-lower'),
  leftHand: named('left-hand-wrist'),
  rightUpperArm: named('right-arm-upper'),
  rightLowerArm: named('right-arm-lower'),
  rightHand: named('right-hand-wrist'),
} as const satisfies Partial<Record<JointName, number>>;

/** A joint of the skeleton that devices report. */
export type SharedJoint = keyof typeof places;

/** Returns the device's position of this joint [m], floor frame. */
export const deviceJoint = (body: DeviceBody, joint: SharedJoint, target: MutableVec3): MutableVec3 =>
  readVec3(body, places[joint], target);

/** Interpolates between two bodies, joint by joint; `fraction` 0: the first. */
export function mixDeviceBodies(
  a: DeviceBody,
  b: DeviceBody,
  fraction: number,
  target: DeviceBody = new Float32Array(deviceBodySize),
): DeviceBody {
  for (let i = 0; i < deviceBodySize; i++) target[i] = a[i]! + (b[i]! - a[i]!) * fraction;
  return target;
}
