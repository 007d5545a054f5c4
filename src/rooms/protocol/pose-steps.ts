import {
  clamp,
  type MutablePose,
  type MutableVec3,
  type Pose,
  type Side,
  setVec3,
  type TrackedPose,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { type FingerSteps, makeFingerSteps } from './finger-steps';
import {
  type DirectionSteps,
  fromQuatSteps,
  makeDirectionSteps,
  makeQuatSteps,
  makeVecSteps,
  maxSteps,
  placeUnit,
  type QuatSteps,
  toQuatSteps,
  type VecSteps,
} from './quantise';
import {
  fromRelativePosition,
  makeRelativePositionSteps,
  type RelativePositionSteps,
  toRelativePosition,
} from './relative-position';

/** Bits of the head's x and z: ±8.19 m in the floor frame, clamped beyond. Headsets allow 15 m at most. */
export const headBits = 16;
/** Bits of the head's height: −1 to 3.095 m above the floor, clamped beyond. */
export const heightBits = 14;
/** Lowest height of a head in a packet [m], floor frame. */
const lowestHead = -1;
/** Bits of the orientations of head and hands: an error of 0.1° at most. */
export const trackedBits = 11;
export const forearmBits = 6;
/** Bits of the swivel angle over ±π: steps of 0.18°. */
export const swivelBits = 11;
/** Range of the clavicle's swing about each of two axes [rad]; most swings are under half of it. */
export const clavicleRange = 1.3;
/** Bits of a free wrist: direction from the shoulder, flexion of the elbow, orientation of the hand. */
export const directionBits = 8;
export const flexionBits = 7;
export const freeHandBits = 6;
/** Bits of the stretch: the signed distance along the arm from the hand to the drawn wrist. */
export const stretchBits = 4;
/** A step of the stretch [m]; the range is ±1.4 mm. */
export const stretchUnit = 0.0002;
/** Bits and range [rad] of the twists of spine and chest: steps of 2.9°. */
export const twistBits = 6;
export const twistRange = Math.PI / 2;
/** Range of a forearm's twist [rad], a quarter turn each way. */
export const forearmRange = Math.PI / 2;

/** The head as steps. */
interface HeadSteps {
  readonly position: VecSteps;
  readonly orientation: QuatSteps;
}

/** The pose of a hand relative to the head, or of an ankle relative to the hips. */
export interface RelativePoseSteps {
  readonly place: RelativePositionSteps;
  readonly orientation: QuatSteps;
}

export interface ArmSteps {
  /** The clavicle's swing about the two axes at right angles to it. */
  clavicleU: number;
  clavicleV: number;
  swivel: number;
  forearmTwist: number;
  /**
   * Distance along the arm from the hand to the drawn wrist: tenths of a millimetre move the elbow of an almost
   * straight arm.
   */
  stretch: number;
  /** Whether the arm ends at a wrist of its own, which the next fields describe; false: it ends at the hand. */
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
  /** Whether the spine is turned otherwise than by a twist against the hips, as trackers bend it. */
  bent: boolean;
  /** The spine of a bent trunk; others have `spineTwist`. */
  readonly spine: QuatSteps;
  spineTwist: number;
  chestTwist: number;
}

export interface BodyBits {
  readonly trunk: number;
  readonly clavicle: number;
}

/** By the number of free arms: the bits that remain for a component of the trunk, and of a clavicle. */
const bitsByFreeArms: readonly BodyBits[] = [
  { trunk: 10, clavicle: 9 },
  { trunk: 9, clavicle: 9 },
  { trunk: 8, clavicle: 8 },
];

export interface BodySteps {
  bits: BodyBits;
  readonly trunk: TrunkSteps;
  readonly arms: Readonly<Record<Side, ArmSteps>>;
}

/** Returns the bits of the body for these arms. */
export const bodyBitsFor = ({ left, right }: BodySteps['arms']): BodyBits =>
  bitsByFreeArms[Number(left.free) + Number(right.free)]!;

export type Tracking = TrackedPose['tracking'] | 'lost';

interface HandSteps {
  tracking: Tracking;
  /** Whether it has a position: a lost hand has that of the body's wrist. */
  placed: boolean;
  readonly at: RelativePoseSteps;
}

interface FootSteps {
  /** Whether a tracker pins the ankle. */
  pinned: boolean;
  readonly at: RelativePoseSteps;
}

const makeRelativePose = (): RelativePoseSteps => ({
  place: makeRelativePositionSteps(),
  orientation: makeQuatSteps(),
});

const makeHandSteps = (): HandSteps => ({
  tracking: 'lost',
  placed: false,
  at: makeRelativePose(),
});

/** A packet as integers. A buffer: fields that a flag excludes have no meaning. */
export interface PacketSteps {
  timeMs: number;
  jump: boolean;
  headTracking: TrackedPose['tracking'];
  readonly head: HeadSteps;
  readonly hands: Readonly<Record<Side, HandSteps>>;
  readonly fingers: Readonly<Record<Side, FingerSteps>>;
  hasBody: boolean;
  readonly body: BodySteps;
  readonly feet: Readonly<Record<Side, FootSteps>>;
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
    trunk: {
      hips: makeQuatSteps(),
      upperChest: makeQuatSteps(),
      neck: makeQuatSteps(),
      bent: false,
      spine: makeQuatSteps(),
      spineTwist: 0,
      chestTwist: 0,
    },
    arms: { left: makeArmSteps(), right: makeArmSteps() },
  },
  feet: { left: { pinned: false, at: makeRelativePose() }, right: { pinned: false, at: makeRelativePose() } },
});

const heightCentre = lowestHead + maxSteps(heightBits) * placeUnit;

export const headPosition = ({ x, y, z }: VecSteps, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, x * placeUnit, y * placeUnit + heightCentre, z * placeUnit);

export const limited = (steps: number, bits: number): number =>
  clamp(Math.round(steps), -maxSteps(bits), maxSteps(bits));

/**
 * Writes the nearest steps of a head, floor frame; positions beyond the ranges of `headBits` and `heightBits` are
 * clamped.
 */
export function headSteps({ position: { x, y, z }, orientation }: Pose<'floor'>, target: HeadSteps): HeadSteps {
  const { position } = target;
  position.x = limited(x / placeUnit, headBits);
  position.y = limited((y - heightCentre) / placeUnit, heightBits);
  position.z = limited(z / placeUnit, headBits);
  toQuatSteps(orientation, trackedBits, target.orientation);
  return target;
}

/**
 * Writes the nearest steps of a hand or ankle, floor frame, relative to the head or hips as the receiver decodes them
 * [m]; see `toRelativePosition` for the range.
 */
export function toRelativePose(
  origin: Vec3,
  { position, orientation }: Pose<'floor'>,
  target: RelativePoseSteps,
): RelativePoseSteps {
  toRelativePosition(origin, position, target.place);
  toQuatSteps(orientation, trackedBits, target.orientation);
  return target;
}

/** Writes the pose of a hand or ankle from its steps, floor frame, relative to the decoded head or hips [m]. */
export function fromRelativePose(
  origin: Vec3,
  { place, orientation }: RelativePoseSteps,
  target: MutablePose<'floor'>,
): MutablePose<'floor'> {
  fromRelativePosition(origin, place, target.position);
  fromQuatSteps(orientation, trackedBits, target.orientation);
  return target;
}

/** Returns the nearest of uniform steps from 0 to 1. */
export const levels = (value: number, bits: number): number =>
  Math.round(clamp(Number.isFinite(value) ? value : 0, 0, 1) * (2 ** bits - 1));
