import { sideSign } from '../../body/skeleton';
import { type ElbowCircle, poleAcross } from '../../body/two-bone-ik';
import { wrapAngle } from '../../math/angle';
import { clamp, smoothingFactor, smoothstep } from '../../math/damper';
import { fromAxes, type Quat, quat, rotate, rotateInverse, rotationBetween } from '../../math/quat';
import type { Side } from '../../math/side';
import {
  add,
  addScaled,
  backward,
  cross,
  distance,
  dot,
  length,
  type MutableVec3,
  normalise,
  reject,
  right,
  scale,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../../math/vec3';
import limits from '../kinematic-limits.json' with { type: 'json' };
import type { TorsoPose } from '../trunk/fit-torso';

const { trunkCapsule: capsule } = limits;

/** The highest speed of an elbow about the line from shoulder to wrist [rad/s]; a punch reaches 10. */
const swivelSpeed = 12;
/** The highest speed of the swivel [rad/s] of a guessed hand. */
const guessedSwivelSpeed = 5;
/** The highest speed of an elbow about the head [m/s] in addition to the hand's own motion. */
export const elbowSpeed = 2;
/** The longest half-life [s] of the swivel angle, where its estimate is uncertain about the side of the elbow. */
const swivelHalfLife = 0.35;
/**
 * The distance [m] of an estimated elbow from the arm's line below which its direction is uncertain: the arm is nearly
 * straight.
 */
const definedPole = 0.04;
/** Confidence in the arm's axis rises from 0 to 1 between these wrist distances from the shoulder [arm lengths]. */
const [handAtShoulder, handAway] = [0.1, 0.3];

/** The state of an elbow that keeps it from flipping, chest frame. */
export interface SwivelState {
  /** From the shoulder to the wrist, unit. */
  readonly axis: MutableVec3;
  /** The direction of the elbow from that line, unit. */
  readonly pole: MutableVec3;
  /** The elbow and the wrist from the head joint [m], floor axes. */
  readonly elbow: MutableVec3;
  readonly wrist: MutableVec3;
}

/** The direction of an estimated elbow from its own arm's line, and its confidence in [0, 1]. */
export interface EstimatedPole {
  readonly direction: MutableVec3;
  confidence: number;
}

const ownAxis = vec3(0, 0, 0);
const turn = quat(0, 0, 0, 1);

/** Writes the pole of an estimated arm, transported to the elbow's circle of the drawn arm; floor frame. */
export function estimatedPole(
  estimated: { readonly shoulder: Vec3; readonly elbow: Vec3; readonly wrist: Vec3 },
  { axis }: ElbowCircle,
  fallbacks: readonly [Vec3, Vec3],
  target: EstimatedPole,
): EstimatedPole {
  const { direction } = target;
  normalise(subtract(estimated.wrist, estimated.shoulder, ownAxis), axis, ownAxis);
  reject(subtract(estimated.elbow, estimated.shoulder, direction), ownAxis, direction);
  target.confidence = smoothstep(0, definedPole, length(direction));
  rotate(rotationBetween(ownAxis, axis, turn), direction, direction);
  poleAcross(axis, direction, fallbacks, direction);
  return target;
}

export interface SwivelContext {
  readonly side: Side;
  readonly torso: TorsoPose;
  /** The head joint, floor frame. */
  readonly headJoint: Vec3;
  /** The longest step of the elbow about the head in this frame [m]. */
  readonly longestStep: number;
  /** Upper arm and forearm together [m]. */
  readonly armLength: number;
  /** The confidence in the hand, in [0, 1]: elbows of guessed hands turn slower. */
  readonly confidence: number;
  readonly deltaSeconds: number;
}

/**
 * Swivel angles are counted about the arm's line from `zero`, which leads away from the trunk, towards `quarter`; both
 * unit, floor frame.
 */
interface SwivelAxes {
  readonly zero: MutableVec3;
  readonly quarter: MutableVec3;
}

/** The swivel angles at which the elbow is clear of the trunk, around 0. */
interface ClearRange {
  low: number;
  high: number;
}

/** The swivel angles that an elbow reaches in a frame: up to `furthest` from the nearest one, to both sides. */
interface ReachedRange {
  nearest: number;
  furthest: number;
}

// Scratch of one call.
const axes: SwivelAxes = { zero: vec3(0, 0, 0), quarter: vec3(0, 0, 0) };
const clear: ClearRange = { low: -Math.PI + 0.5, high: Math.PI - 0.5 };
const reached: ReachedRange = { nearest: 0.5, furthest: 0.5 };
const carried = vec3(0, 0, 0);
const fromHead = vec3(0, 0, 0);

/** Writes the axes for an arm along `axis`; for an arm along the chest's side axis, `zero` is backward. */
function swivelAxes(side: Side, floorFromChest: Quat, axis: Vec3, { zero, quarter }: SwivelAxes): void {
  reject(rotate(floorFromChest, setVec3(zero, sideSign(side), 0, 0), zero), axis, zero);
  if (length(zero) <= 1e-3) reject(rotate(floorFromChest, backward, zero), axis, zero);
  normalise(zero, undefined, zero);
  cross(axis, zero, quarter);
}

const angleOf = (direction: Vec3, { zero, quarter }: SwivelAxes): number =>
  Math.atan2(dot(direction, quarter), dot(direction, zero));

function poleAt(angle: number, { zero, quarter }: SwivelAxes, target: MutableVec3): MutableVec3 {
  scale(zero, Math.cos(angle), target);
  return addScaled(target, quarter, Math.sin(angle), target);
}

/**
 * Writes the direction of the elbow: it follows the estimate around the outside of the trunk, with limited speed, and
 * slowly if the estimate is uncertain. The previous direction (null: none) is transported with the arm. The first frame
 * uses the estimate, moved out of the trunk.
 */
export function limitSwivel(
  before: SwivelState | null,
  wantedPole: EstimatedPole,
  circle: ElbowCircle,
  context: SwivelContext,
  target: MutableVec3,
): MutableVec3 {
  const { side, torso, headJoint, longestStep, armLength, confidence, deltaSeconds } = context;
  const { axis } = circle;
  const floorFromChest = torso.rotations.upperChest;
  swivelAxes(side, floorFromChest, axis, axes);
  const limited = findClearRange(circleInCapsule(circle, axes, torso, inTrunk), clear);
  const estimated = angleOf(wantedPole.direction, axes);
  const wanted = limited ? nearestWithin(clear, estimated) : estimated;
  if (before === null) return poleAt(wanted, axes, target);

  rotationBetween(rotate(floorFromChest, before.axis, carried), axis, turn);
  rotate(turn, rotate(floorFromChest, before.pole, carried), carried);
  const kept = angleOf(carried, axes);
  const inside = limited && nearestWithin(clear, kept) !== kept;
  // The elbow takes the shorter way, or the one that does not lead through the trunk.
  const toGo = limited && !inside ? wanted - kept : wrapAngle(wanted - kept);
  const defined = wantedPole.confidence * smoothstep(handAtShoulder * armLength, handAway * armLength, circle.span);
  const fraction = smoothingFactor(swivelHalfLife * (1 - defined) ** 3, deltaSeconds);
  const most = (guessedSwivelSpeed + (swivelSpeed - guessedSwivelSpeed) * confidence) * Math.max(deltaSeconds, 0);
  const followed = clamp(inside ? toGo : toGo * fraction, -most, most);
  findReachedRange(add(headJoint, before.elbow, fromHead), circle, longestStep, reached);
  const nearest = kept + wrapAngle(reached.nearest - kept);
  return poleAt(nearest + clamp(kept + followed - nearest, -reached.furthest, reached.furthest), axes, target);
}

/**
 * Writes the swivel angles at which the elbow is no further than `longestStep` [m] from where it was, as carried by the
 * head. Where the circle is further away, only its nearest angle is reached.
 */
function findReachedRange(
  elbow: Vec3,
  { centre, radius }: ElbowCircle,
  longestStep: number,
  target: ReachedRange,
): void {
  subtract(elbow, centre, fromHead);
  const ahead = dot(fromHead, axes.zero);
  const aside = dot(fromHead, axes.quarter);
  const across = Math.sqrt(ahead * ahead + aside * aside);
  // The squared distance to the elbow's former place grows from that of the nearest angle on.
  const least = dot(fromHead, fromHead) - across * across + (across - radius) ** 2;
  const cosine = 1 - (longestStep * longestStep - least) / Math.max(2 * radius * across, 1e-9);
  target.nearest = Math.atan2(aside, ahead);
  target.furthest = Math.acos(clamp(cosine, -1, 1));
}

/** Returns the clear angle nearest to an angle in (−π, π]. */
function nearestWithin({ low, high }: ClearRange, angle: number): number {
  if (angle >= low && angle <= high) return angle;
  // The larger the cosine, the smaller the turn.
  return Math.cos(angle - low) > Math.cos(angle - high) ? low : high;
}

/**
 * The number of parts in a turn: angles are sampled in steps of 10°, and borders found to a sixty-fourth of a step, one
 * part.
 */
const partsPerStep = 64;
const partsPerHalfTurn = 18 * partsPerStep;
const swivelPart = Math.PI / partsPerHalfTurn;
/** The cosines of whole steps from 0 to half a turn, which most samples use. */
const stepCosines = Float64Array.from({ length: 19 }, (_, step) => Math.cos(step * partsPerStep * swivelPart));
const stepSines = Float64Array.from({ length: 19 }, (_, step) => Math.sin(step * partsPerStep * swivelPart));

const side = vec3(0, 0, 0);
const trunkUp = vec3(0, 0, 0);
const floorFromTrunk = quat(0, 0, 0, 1);
const behind = vec3(0, 0, 0);

/** An elbow's circle in the trunk's frame and in the capsule's units (`inCapsule`). */
interface CircleInCapsule {
  readonly centre: MutableVec3;
  /** The circle's radius towards `zero` and `quarter`. */
  readonly towardsZero: MutableVec3;
  readonly towardsQuarter: MutableVec3;
  /** From the hips to the neck [heights of the capsule's caps]. */
  trunkHeight: number;
}

const inTrunk: CircleInCapsule = {
  centre: vec3(0, 0, 0),
  towardsZero: vec3(0, 0, 0),
  towardsQuarter: vec3(0, 0, 0),
  trunkHeight: 0.5,
};

/**
 * Returns a vector in units of the trunk's capsule: half its width, the height of its caps and half its depth for x, y
 * and z.
 */
function inCapsule(v: Vec3, unit: number, target: MutableVec3): MutableVec3 {
  rotateInverse(floorFromTrunk, v, target);
  target.x /= capsule.halfWidth * unit;
  target.y /= capsule.cap * unit;
  target.z /= capsule.halfDepth * unit;
  return target;
}

/** Returns the squared distance of a point from the axis of a capsule of this height; below 1 the point is inside. */
function squaredDistance(x: number, y: number, z: number, height: number): number {
  const beyond = y - clamp(y, 0, height);
  return x * x + beyond * beyond + z * z;
}

/** Places an elbow's circle, floor frame, beside the capsule of this trunk. */
function circleInCapsule(
  circle: ElbowCircle,
  { zero, quarter }: SwivelAxes,
  { hips, chest, neck, rotations }: TorsoPose,
  target: CircleInCapsule,
): CircleInCapsule {
  const { centre, towardsZero, towardsQuarter } = target;
  const unit = distance(neck, chest);
  normalise(subtract(neck, hips, trunkUp), up, trunkUp);
  normalise(reject(rotate(rotations.upperChest, right, side), trunkUp, side), right, side);
  fromAxes(side, trunkUp, cross(side, trunkUp, behind), floorFromTrunk);
  target.trunkHeight = distance(neck, hips) / (capsule.cap * unit);
  inCapsule(subtract(circle.centre, hips, centre), unit, centre);
  inCapsule(scale(zero, circle.radius, towardsZero), unit, towardsZero);
  inCapsule(scale(quarter, circle.radius, towardsQuarter), unit, towardsQuarter);
  return target;
}

/** Writes the range of swivel angles at which an elbow is clear of the trunk; returns false if all are. */
function findClearRange(circle: CircleInCapsule, target: ClearRange): boolean {
  const { centre, towardsZero, towardsQuarter, trunkHeight } = circle;
  const furthest = Math.sqrt(dot(towardsZero, towardsZero) + dot(towardsQuarter, towardsQuarter));
  if (Math.sqrt(squaredDistance(centre.x, centre.y, centre.z, trunkHeight)) - furthest >= 1) return false;
  target.high = border(circle, 1);
  target.low = -border(circle, -1);
  return target.high < Math.PI || target.low > -Math.PI;
}

/**
 * Returns whether the elbow is inside the trunk at this angle [parts of a turn]; integers are passed without boxing.
 */
function isInside({ centre, towardsZero, towardsQuarter, trunkHeight }: CircleInCapsule, parts: number): boolean {
  const step = Math.abs(parts) / partsPerStep;
  const whole = Number.isInteger(step);
  const cosine = whole ? stepCosines[step]! : Math.cos(parts * swivelPart);
  const sine = whole ? Math.sign(parts) * stepSines[step]! : Math.sin(parts * swivelPart);
  return (
    squaredDistance(
      centre.x + towardsZero.x * cosine + towardsQuarter.x * sine,
      centre.y + towardsZero.y * cosine + towardsQuarter.y * sine,
      centre.z + towardsZero.z * cosine + towardsQuarter.z * sine,
      trunkHeight,
    ) < 1
  );
}

/** Returns the last clear angle from 0 in the direction of `sign` [parts]. */
function border(circle: CircleInCapsule, sign: 1 | -1): number {
  let blocked = partsPerStep;
  while (blocked <= partsPerHalfTurn && !isInside(circle, sign * blocked)) blocked += partsPerStep;
  if (blocked > partsPerHalfTurn) return Math.PI;
  let clearParts = blocked - partsPerStep;
  while (blocked - clearParts > 1) {
    const middle = (clearParts + blocked) >> 1;
    if (isInside(circle, sign * middle)) blocked = middle;
    else clearParts = middle;
  }
  return clearParts * swivelPart;
}
