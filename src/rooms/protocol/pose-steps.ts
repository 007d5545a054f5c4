import { clamp } from 'threepoint/core/math/damper';
import type { MutablePose, Pose, TrackedPose } from 'threepoint/core/math/pose';
import type { Side } from 'threepoint/core/math/side';
import { type MutableVec3, setVec3, type Vec3, vec3 } from 'threepoint/core/math/vec3';
import { type FingerSteps, makeFingerSteps } from './finger-steps';
import { fromHandPlace, type HandPlaceSteps, makeHandPlaceSteps, toHandPlace } from './hand-place';
import {
  type DirectionSteps,
  fromQuatSteps,
  makeDirectionSteps,
  makeQuatSteps,
  makeVecSteps,
  mostSteps,
  placeUnit,
  type QuatSteps,
  toQuatSteps,
  type VecSteps,
} from './quantise';

/** Bits of the head's x and z: ±8.19 m from the origin of the floor frame; beyond: at the edge. No headset plays in more than 15 m. */
export const headBits = 16;
/** Bits of the head's height: −1 to 3.095 m above the floor; beyond: at the edge. */
export const heightBits = 14;
/** Lowest height of a head on the wire [m], floor frame. */
const lowestHead = -1;
/** Of head and hands: 0.1° at most. */
export const trackedBits = 11;
export const forearmBits = 6;
/** Of the swivel angle over ±π: steps of 0.18°. */
export const swivelBits = 11;
/** A clavicle swings ±1.3 rad about each of two axes, and mostly by less than half of that. */
export const clavicleRange = 1.3;
/** A wrist of its own: which way from the shoulder, how far the elbow is bent, and how the hand is turned there. */
export const directionBits = 8;
export const flexionBits = 7;
export const freeHandBits = 6;
/** How far a wrist is drawn beyond the hand, or before it, along its arm: signed steps of so many bits. */
export const stretchBits = 4;
/** A step of that [m]: ±1.4 mm in all. */
export const stretchUnit = 0.0002;
/** What is left for the trunk when one arm has a wrist of its own, when both have, and otherwise. */
const trunkBitsFor = (freeArms: number): number => 10 - freeArms;
const clavicleBitsFor = (freeArms: number): number => (freeArms === 2 ? 8 : 9);
const twistBitsFor = (freeArms: number): number => (freeArms > 0 ? 6 : 7);
/** A forearm twists a quarter turn either way. */
export const forearmRange = Math.PI / 2;

/** The head as steps. */
interface HeadSteps {
  readonly position: VecSteps;
  readonly orientation: QuatSteps;
}

/** Where a hand is from the head, and how it is turned. */
interface HandPoseSteps {
  readonly place: HandPlaceSteps;
  readonly orientation: QuatSteps;
}

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

interface HandSteps {
  tracking: Tracking;
  /** Whether it is anywhere: a lost hand is where the body's wrist is. */
  placed: boolean;
  readonly at: HandPoseSteps;
}

const makeHandSteps = (): HandSteps => ({
  tracking: 'lost',
  placed: false,
  at: { place: makeHandPlaceSteps(), orientation: makeQuatSteps() },
});

/** A whole packet as whole numbers: a buffer, in which what a flag denies means nothing. */
export interface PacketSteps {
  timeMs: number;
  jump: boolean;
  headTracking: TrackedPose['tracking'];
  readonly head: HeadSteps;
  readonly hands: Readonly<Record<Side, HandSteps>>;
  readonly fingers: Readonly<Record<Side, FingerSteps>>;
  hasBody: boolean;
  readonly body: BodySteps;
}

export const makePacketSteps = (): PacketSteps => ({
  timeMs: 0,
  jump: false,
  headTracking: 'tracked',
  head: { position: makeVecSteps(), orientation: makeQuatSteps() },
  hands: { left: makeHandSteps(), right: makeHandSteps() },
  fingers: { left: makeFingerSteps(), right: makeFingerSteps() },
  hasBody: false,
  body: {
    bits: bitsByFreeArms[0]!,
    trunk: { hips: makeQuatSteps(), upperChest: makeQuatSteps(), neck: makeQuatSteps(), spineTwist: 0, chestTwist: 0 },
    arms: { left: makeArmSteps(), right: makeArmSteps() },
  },
});

const heightCentre = lowestHead + mostSteps(heightBits) * placeUnit;

export const headPosition = ({ x, y, z }: VecSteps, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, x * placeUnit, y * placeUnit + heightCentre, z * placeUnit);

export const limited = (steps: number, bits: number): number =>
  clamp(Math.round(steps), -mostSteps(bits), mostSteps(bits));

/** The nearest steps to a head, floor frame; positions beyond the ranges of `headBits` and `heightBits` end at the edge. */
export function headSteps({ position: { x, y, z }, orientation }: Pose<'floor'>, target: HeadSteps): HeadSteps {
  const { position } = target;
  position.x = limited(x / placeUnit, headBits);
  position.y = limited((y - heightCentre) / placeUnit, heightBits);
  position.z = limited(z / placeUnit, headBits);
  toQuatSteps(orientation, trackedBits, target.orientation);
  return target;
}

/** The nearest steps to a hand, floor frame, from a head at `head` [m] as the receiver has it; see `toHandPlace` for hands far off. */
export function handSteps(head: Vec3, { position, orientation }: Pose<'floor'>, target: HandPoseSteps): HandPoseSteps {
  toHandPlace(head, position, target.place);
  toQuatSteps(orientation, trackedBits, target.orientation);
  return target;
}

/** Writes the pose of a hand as steps tell it, floor frame; `head`: as the receiver has it [m]. */
export function handPose(
  head: Vec3,
  { place, orientation }: HandPoseSteps,
  target: MutablePose<'floor'>,
): MutablePose<'floor'> {
  fromHandPlace(head, place, target.position);
  fromQuatSteps(orientation, trackedBits, target.orientation);
  return target;
}

/** The nearest of the even steps from 0 to 1. */
export const levels = (value: number, bits: number): number =>
  Math.round(clamp(Number.isFinite(value) ? value : 0, 0, 1) * (2 ** bits - 1));
