import { clamp } from '../math/damper';
import type { MutablePose, Pose, TrackedPose } from '../math/pose';
import type { Side } from '../math/side';
import { add, type MutableVec3, setVec3, type Vec3, vec3 } from '../math/vec3';
import { type FingerSteps, makeFingerSteps } from './finger-steps';
import {
  type DirectionSteps,
  fromQuatSteps,
  makeDirectionSteps,
  makeQuatSteps,
  makeVecSteps,
  mostSteps,
  type QuatSteps,
  toQuatSteps,
  type VecSteps,
} from './quantise';

export const sides = ['left', 'right'] as const;

/** A length on the wire is a multiple of this [m]. */
export const unit = 0.0005;
/** The head: ±16 m from the origin of the floor frame, −1 to 3.09 m above it; beyond: at the edge. */
export const headBits = 16;
export const heightBits = 13;
export const lowestHead = -1;
/** A hand: ±2 m from the head on each axis; beyond: at the edge. */
export const handBits = 13;
/** Of head and hands: 0.1° at most. */
export const trackedBits = 11;
export const forearmBits = 6;
export const swivelBits = 9;
/** A clavicle swings ±1.3 rad about each of two axes. */
export const clavicleRange = 1.3;
/** A wrist of its own: which way from the shoulder, how far the elbow is bent, and how the hand is turned there. */
export const directionBits = 8;
export const flexionBits = 7;
export const freeHandBits = 6;
/** How far a wrist is drawn beyond the hand, or before it, along its arm: multiples of this [m]. */
export const stretchBits = 5;
export const stretchUnit = 0.0001;
/** What is left for the trunk when one arm has a wrist of its own, when both have, and otherwise. */
export const trunkBitsFor = (freeArms: number): number => 10 - freeArms;
export const clavicleBitsFor = (freeArms: number): number => (freeArms === 2 ? 8 : 9);
export const twistBitsFor = (freeArms: number): number => (freeArms === 2 ? 6 : 7);
/** A forearm twists a quarter turn either way. */
export const forearmRange = Math.PI / 2;

/** A pose as steps. */
export interface PoseSteps {
  readonly position: VecSteps;
  readonly orientation: QuatSteps;
}

const makePoseSteps = (): PoseSteps => ({ position: makeVecSteps(), orientation: makeQuatSteps() });

export interface ArmSteps {
  /** The clavicle's swing about the two axes at right angles to it. */
  clavicleU: number;
  clavicleV: number;
  swivel: number;
  forearmTwist: number;
  /** The hand's own wrist and how far beyond it along the arm; an almost straight arm's elbow tells tenths of a millimetre apart. */
  stretch: number;
  /** Whether the body has a wrist of its own, told by the rest; false: the arm reaches for the hand. */
  free: boolean;
  readonly direction: DirectionSteps;
  flexion: number;
  readonly hand: QuatSteps;
}

const makeArmSteps = (): ArmSteps => ({
  clavicleU: 0,
  clavicleV: 0,
  swivel: 0,
  forearmTwist: 0,
  stretch: 0,
  free: false,
  direction: makeDirectionSteps(),
  flexion: 0,
  hand: makeQuatSteps(),
});

export interface TrunkSteps {
  readonly hips: QuatSteps;
  readonly upperChest: QuatSteps;
  readonly neck: QuatSteps;
  spineTwist: number;
  chestTwist: number;
}

export interface BodyBits {
  readonly trunk: number;
  readonly twist: number;
  readonly clavicle: number;
}

const bitsByFreeArms = [0, 1, 2].map(
  (count): BodyBits => ({ trunk: trunkBitsFor(count), twist: twistBitsFor(count), clavicle: clavicleBitsFor(count) }),
);

export interface BodySteps {
  bits: BodyBits;
  readonly trunk: TrunkSteps;
  readonly arms: Readonly<Record<Side, ArmSteps>>;
}

/** What is left for the body when these of its arms have wrists of their own. */
export const bodyBitsFor = ({ left, right }: BodySteps['arms']): BodyBits =>
  bitsByFreeArms[Number(left.free) + Number(right.free)]!;

export type Tracking = TrackedPose['tracking'] | 'lost';

export interface HandSteps {
  tracking: Tracking;
  /** Whether it is anywhere: a lost hand is where the body's wrist is. */
  placed: boolean;
  readonly at: PoseSteps;
}

const makeHandSteps = (): HandSteps => ({ tracking: 'lost', placed: false, at: makePoseSteps() });

/** A whole packet as whole numbers: a buffer, in which what a flag denies means nothing. */
export interface PacketSteps {
  timeMs: number;
  jump: boolean;
  headTracking: TrackedPose['tracking'];
  readonly head: PoseSteps;
  readonly hands: Readonly<Record<Side, HandSteps>>;
  readonly fingers: Readonly<Record<Side, FingerSteps>>;
  hasBody: boolean;
  readonly body: BodySteps;
}

export const makePacketSteps = (): PacketSteps => ({
  timeMs: 0,
  jump: false,
  headTracking: 'tracked',
  head: makePoseSteps(),
  hands: { left: makeHandSteps(), right: makeHandSteps() },
  fingers: { left: makeFingerSteps(), right: makeFingerSteps() },
  hasBody: false,
  body: {
    bits: bitsByFreeArms[0]!,
    trunk: { hips: makeQuatSteps(), upperChest: makeQuatSteps(), neck: makeQuatSteps(), spineTwist: 0, chestTwist: 0 },
    arms: { left: makeArmSteps(), right: makeArmSteps() },
  },
});

const heightCentre = lowestHead + mostSteps(heightBits) * unit;

export const headPosition = ({ x, y, z }: VecSteps, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, x * unit, y * unit + heightCentre, z * unit);

export const limited = (steps: number, bits: number): number =>
  clamp(Math.round(steps), -mostSteps(bits), mostSteps(bits));

export function headSteps({ position: { x, y, z }, orientation }: Pose<'floor'>, target: PoseSteps): PoseSteps {
  const { position } = target;
  position.x = limited(x / unit, headBits);
  position.y = limited((y - heightCentre) / unit, heightBits);
  position.z = limited(z / unit, headBits);
  toQuatSteps(orientation, trackedBits, target.orientation);
  return target;
}

export function handSteps(head: Vec3, { position: hand, orientation }: Pose<'floor'>, target: PoseSteps): PoseSteps {
  const { position } = target;
  position.x = limited((hand.x - head.x) / unit, handBits);
  position.y = limited((hand.y - head.y) / unit, handBits);
  position.z = limited((hand.z - head.z) / unit, handBits);
  toQuatSteps(orientation, trackedBits, target.orientation);
  return target;
}

export function handPose(
  head: Vec3,
  { position: { x, y, z }, orientation }: PoseSteps,
  target: MutablePose<'floor'>,
): MutablePose<'floor'> {
  const { position } = target;
  add(head, setVec3(position, x * unit, y * unit, z * unit), position);
  fromQuatSteps(orientation, trackedBits, target.orientation);
  return target;
}

/** The nearest of the even steps from 0 to 1. */
export const levels = (value: number, bits: number): number =>
  Math.round(clamp(Number.isFinite(value) ? value : 0, 0, 1) * (2 ** bits - 1));
