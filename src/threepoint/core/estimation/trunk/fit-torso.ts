import { clavicleRest, clavicleRoot } from '../../body/arm-rotations';
import { clamp, smoothingFactor, smoothstep } from '../../math/damper';
import {
  alignDirections,
  limitAngle,
  type MutableQuat,
  multiply,
  type Quat,
  quat,
  rotate,
  rotationBetween,
} from '../../math/quat';
import type { Side } from '../../math/side';
import {
  add,
  addScaled,
  backward,
  copyVec3,
  cross,
  dot,
  down,
  length,
  lerp,
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
import { recordOf } from '../../records';
import type { CompletedFrame } from '../complete-hands';
import type { JointPositions } from '../joint-positions';
import limits from '../kinematic-limits.json' with { type: 'json' };
import { followLean, increaseLean, type Lean, makeLean, startLeanFrame } from './lean-after-hand';
import type { TorsoBones } from './torso-bones';

const { torso: torsoLimits, torsoExtreme: extremeLimits } = limits;
const { anatomicalPasses, extremePasses } = limits.reach;
const { shortestClavicle } = torsoLimits;

/** The highest turning speed of the shoulders [rad/s]; a pirouette reaches 12. */
const turnSpeed = 12;
/**
 * The longest half-life [s] of the shoulder line, used where the estimated shoulders are too close together to define
 * it.
 */
const shoulderLineHalfLife = 0.15;
/** Confidence in the shoulder line rises from 0 to 1 between these shoulder distances [fraction of rest width]. */
const [undefinedLine, definedLine] = [0.2, 0.7];
/** The highest speed of the hips about the chest joint [rad/s]: 4 cm in a frame at 60 Hz. */
const hipsTurnSpeed = 6;
/** Fraction of the turn from the pelvis to the shoulders' line that the lower back has made [1]. */
const spineToShoulders = 0.35;
/** The height [m] of the hip joints' middle when sitting on the floor. */
const lowestHips = 0.09;

/** The bones of the trunk, parents first. */
export const trunkBones = ['hips', 'spine', 'chest', 'upperChest', 'neck'] as const;
export type TrunkRotations = Readonly<Record<(typeof trunkBones)[number], MutableQuat>>;
export const makeTrunkRotations = (): TrunkRotations => recordOf(trunkBones, () => quat(0, 0, 0, 1));

/** A trunk with fixed bone lengths under the head, floor frame. */
export interface TorsoPose {
  readonly hips: MutableVec3;
  readonly chest: MutableVec3;
  readonly neck: MutableVec3;
  readonly rotations: TrunkRotations;
  readonly clavicles: Readonly<Record<Side, MutableQuat>>;
  readonly shoulders: Readonly<Record<Side, MutableVec3>>;
}

export interface FitTorsoState {
  /** False before the first frame. */
  known: boolean;
  readonly pose: TorsoPose;
  /** From the left to the right estimated shoulder, unit, floor frame. */
  readonly shoulderLine: MutableVec3;
  /** From the chest joint to the hips, unit, floor frame. */
  readonly towardsHips: MutableVec3;
  readonly lean: Readonly<Record<Side, Lean>>;
}

export const makeFitTorsoState = (): FitTorsoState => ({
  known: false,
  pose: {
    hips: vec3(0, 0, 0),
    chest: vec3(0, 0, 0),
    neck: vec3(0, 0, 0),
    rotations: makeTrunkRotations(),
    clavicles: { left: quat(0, 0, 0, 1), right: quat(0, 0, 0, 1) },
    shoulders: { left: vec3(0, 0, 0), right: vec3(0, 0, 0) },
  },
  shoulderLine: vec3(1, 0, 0),
  towardsHips: vec3(0, -1, 0),
  lean: { left: makeLean(), right: makeLean() },
});

/** The input of `fitTorso` in one frame, floor frame. */
interface TorsoInput {
  readonly joints: JointPositions;
  readonly frame: CompletedFrame;
  readonly bones: TorsoBones;
  readonly deltaSeconds: number;
}

/** The placed thorax, for the spine below it; floor frame, unit. */
const thorax = {
  /** From the chest joint to the neck. */
  up: vec3(0, 0, 0),
  /** From the left to the right shoulder as the thorax faces. */
  line: vec3(0, 0, 0),
};
/** The thorax of a frame before leaning, floor frame. */
const unleaned = {
  /** From the chest joint to the neck, unit. */
  up: vec3(0, 0, 0),
  /** From the left to the right side of the thorax, at right angles to `up`, unit. */
  line: vec3(0, 0, 0),
  /** From the neck to the head joint [m]. */
  neckToHead: vec3(0, 0, 0),
  /** The part of the neck's displacement onto its bone length that chest joint and hips follow [m]. */
  moved: vec3(0, 0, 0),
};
/** The targets of the shoulders, floor frame. */
const shoulderTargets: Readonly<Record<Side, MutableVec3>> = { left: vec3(0, 0, 0), right: vec3(0, 0, 0) };
const headingRight = vec3(0, 0, 0);
const lineBefore = vec3(0, 0, 0);
const meanLean = vec3(0, 0, 0);
/** The thorax's shoulder line after the turn about its length and before the lean of the length; unit. */
const turnedLine = vec3(0, 0, 0);
const shoulderMiddle = vec3(0, 0, 0);
/** The base of the neck for the wanted shoulders, before it is moved to the neck's length from the head. */
const impliedNeck = vec3(0, 0, 0);
/** From the neck to the head on a neck at rest [m]. */
const neckAtRest = vec3(0, 0, 0);
const turnAxis = vec3(0, 0, 0);
const unleanedNeck = vec3(0, 0, 0);
const leanedNeck = vec3(0, 0, 0);
const clavicle = { root: vec3(0, 0, 0), rest: vec3(0, 0, 0), wanted: vec3(0, 0, 0) };
const spine = { hips: vec3(0, 0, 0), up: vec3(0, 0, 0), pelvis: vec3(0, 0, 0), vertebra: vec3(0, 0, 0) };
const hipsBefore = vec3(0, 0, 0);
const rotation = quat(0, 0, 0, 1);
const swing = quat(0, 0, 0, 1);

/**
 * Fits the trunk (stage 5): neck, chest joint, hips and clavicles with fixed bone lengths under the head, as near to
 * their estimates as possible. It leans and turns towards hands that the arms cannot reach, or only when straight.
 */
export function fitTorso(
  state: FitTorsoState,
  joints: JointPositions,
  frame: CompletedFrame,
  bones: TorsoBones,
  deltaSeconds: number,
): TorsoPose {
  const { pose, lean } = state;
  const input: TorsoInput = { joints, frame, bones, deltaSeconds };
  setVec3(headingRight, Math.cos(frame.heading.yaw), 0, -Math.sin(frame.heading.yaw));
  startLeanFrame(lean.left);
  startLeanFrame(lean.right);
  followShoulderLine(state, joints, bones, deltaSeconds);
  placeUprightNeck(state.shoulderLine, input, unleaned);
  for (let pass = 0; pass <= anatomicalPasses + extremePasses; pass++) {
    placeThorax(state, input, lean.left.wanted, lean.right.wanted, thorax);
    const pulledLeft = increaseLean(lean.left, pose.shoulders.left, frame.leftHand, bones.reach, pass);
    const pulledRight = increaseLean(lean.right, pose.shoulders.right, frame.rightHand, bones.reach, pass);
    if (!pulledLeft && !pulledRight) break;
  }
  const leansLeft = followLean(lean.left, frame.leftHand, state.known, deltaSeconds);
  const leansRight = followLean(lean.right, frame.rightHand, state.known, deltaSeconds);
  if (!leansLeft || !leansRight) placeThorax(state, input, lean.left.offset, lean.right.offset, thorax);
  placeSpine(state, input, thorax);
  state.known = true;
  return pose;
}

/**
 * Follows the line through the estimated shoulders: never faster than `turnSpeed`, and slowly where they are estimated
 * close together. Independent of leans, so that the line settles at rest.
 */
function followShoulderLine(
  { shoulderLine: line, known }: FitTorsoState,
  { leftUpperArm, rightUpperArm }: JointPositions,
  { shoulderWidth }: TorsoBones,
  deltaSeconds: number,
): void {
  const before = copyVec3(known ? line : headingRight, lineBefore);
  const apart = length(subtract(rightUpperArm, leftUpperArm, line));
  normalise(line, before, line);
  if (!known) return;
  const confidence = smoothstep(undefinedLine, definedLine, apart / shoulderWidth);
  const fraction = smoothingFactor(shoulderLineHalfLife * (1 - confidence), deltaSeconds);
  turnTowards(line, before, fraction, turnSpeed * Math.max(deltaSeconds, 0));
}

/** Turns `before` towards `wanted` by min(fraction·angle, most) [rad] and writes the result into `wanted`; all unit. */
function turnTowards(wanted: MutableVec3, before: Vec3, fraction: number, most: number): void {
  const angle = Math.atan2(length(cross(before, wanted, turnAxis)), dot(before, wanted));
  const turn = Math.min(angle * fraction, most);
  if (angle - turn < 1e-9) return;
  normalise(cross(turnAxis, before, turnAxis), headingRight, turnAxis);
  scale(before, Math.cos(turn), wanted);
  normalise(addScaled(wanted, turnAxis, Math.sin(turn), wanted), before, wanted);
}

/**
 * Returns the limit of the clavicle's swing or the neck's bend relative to the thorax [rad]. `extremity`: from the
 * anatomical limit (0) to the extreme (1).
 */
const limitOf = (joint: 'clavicleSwing' | 'neckBend', extremity: number): number =>
  torsoLimits[joint] + extremity * (extremeLimits[joint] - torsoLimits[joint]);

/** Places neck and thorax below the head by their estimates, before any lean. */
function placeUprightNeck(
  shoulderLine: Vec3,
  { joints, frame, bones }: TorsoInput,
  { up: thoraxUp, line, neckToHead, moved }: typeof unleaned,
): void {
  lerp(joints.leftUpperArm, joints.rightUpperArm, 0.5, shoulderMiddle);
  normalise(subtract(shoulderMiddle, joints.chest, thoraxUp), up, thoraxUp);
  const chest = alignDirections(bones.thorax, thoraxUp, shoulderLine, rotation);
  rotate(chest, right, line);
  subtract(shoulderMiddle, rotate(chest, bones.shouldersFromNeck, impliedNeck), impliedNeck);
  rotate(chest, bones.neck.main, neckAtRest);
  limitAngle(
    rotationBetween(neckAtRest, subtract(frame.headJoint, impliedNeck, neckToHead), swing),
    torsoLimits.neckBend,
    swing,
  );
  rotate(swing, neckAtRest, neckToHead);

  // Chest joint and hips follow a fraction of the neck's displacement.
  subtract(subtract(frame.headJoint, neckToHead, moved), impliedNeck, moved);
  const far = length(moved);
  scale(moved, torsoLimits.neckShiftShare * Math.min(1, bones.neckLength / Math.max(far, 1e-9)), moved);
}

/**
 * Places neck, chest joint, upper chest and shoulders for leans by these offsets [m]. A lean turns the thorax about its
 * length, then its length and the neck, each by less than a right angle, so that none flips. The part of an offset that
 * points back along a bone is left to the clavicles.
 */
function placeThorax(
  state: FitTorsoState,
  { joints, frame, bones }: TorsoInput,
  leftLean: Vec3,
  rightLean: Vec3,
  { up: thoraxUp, line }: typeof thorax,
): void {
  const { pose, lean } = state;
  const neckBend = limitOf('neckBend', Math.max(lean.left.extremity, lean.right.extremity));
  const { upperChest } = pose.rotations;
  add(joints.leftUpperArm, leftLean, shoulderTargets.left);
  add(joints.rightUpperArm, rightLean, shoulderTargets.right);
  lerp(leftLean, rightLean, 0.5, meanLean);
  reject(subtract(rightLean, leftLean, turnedLine), unleaned.up, turnedLine);
  leanDirection(unleaned.line, bones.shoulderWidth, turnedLine, turnedLine);
  leanDirection(unleaned.up, bones.thoraxLength, meanLean, thoraxUp);

  const roughChest = turnThorax(bones, thoraxUp, line, rotation);
  rotate(roughChest, bones.neck.main, neckAtRest);
  normalise(unleaned.neckToHead, up, unleanedNeck);
  leanDirection(unleanedNeck, bones.neckLength, scale(meanLean, -1, meanLean), leanedNeck);
  limitAngle(rotationBetween(neckAtRest, leanedNeck, swing), neckBend, swing);
  subtract(frame.headJoint, rotate(swing, neckAtRest, neckAtRest), pose.neck);
  normalise(subtract(pose.neck, add(joints.chest, unleaned.moved, thoraxUp), thoraxUp), unleaned.up, thoraxUp);
  addScaled(pose.neck, thoraxUp, -bones.thoraxLength, pose.chest);
  turnThorax(bones, thoraxUp, line, upperChest);
  placeShoulder('left', pose, bones, shoulderTargets.left, limitOf('clavicleSwing', lean.left.extremity));
  placeShoulder('right', pose, bones, shoulderTargets.right, limitOf('clavicleSwing', lean.right.extremity));
}

/**
 * Writes the rotation of a thorax with this direction (unit): the smallest rotation from the estimated direction,
 * applied to the turned line. Line and direction stay normal to each other.
 */
function turnThorax(bones: TorsoBones, thoraxUp: Vec3, line: MutableVec3, target: MutableQuat): MutableQuat {
  rotate(rotationBetween(unleaned.up, thoraxUp, swing), turnedLine, line);
  return alignDirections(bones.thorax, thoraxUp, line, target);
}

/**
 * Writes the direction of a bone (unit direction, length [m]) after its end was moved by an offset. The part that
 * points back along the bone is left out, so that the bone turns by less than a right angle.
 */
function leanDirection(direction: Vec3, boneLength: number, offset: Vec3, target: MutableVec3): void {
  addScaled(offset, direction, boneLength - Math.min(dot(offset, direction), 0), target);
  normalise(target, direction, target);
}

/**
 * Writes the direction of a clavicle towards its shoulder's target, lengthened along the clavicle at rest: near the
 * root, or behind it, the target has no side to swing to.
 */
function aimClavicle({ root, rest, wanted }: typeof clavicle, target: Vec3): MutableVec3 {
  subtract(target, root, wanted);
  const alongRest = dot(wanted, rest) / dot(rest, rest);
  return alongRest < shortestClavicle ? addScaled(wanted, rest, shortestClavicle - alongRest, wanted) : wanted;
}

/** Writes a shoulder on its clavicle, which swings towards its target. */
export function placeShoulder(
  side: Side,
  { neck, rotations, clavicles, shoulders }: TorsoPose,
  { skeleton }: Pick<TorsoBones, 'skeleton'>,
  target: Vec3,
  furthestSwing: number,
): void {
  const root = clavicleRoot(side, neck, rotations.upperChest, skeleton, clavicle.root);
  const rest = rotate(rotations.upperChest, clavicleRest(side, skeleton), clavicle.rest);
  limitAngle(rotationBetween(rest, aimClavicle(clavicle, target), swing), furthestSwing, swing);
  add(root, rotate(swing, rest, rest), shoulders[side]);
  multiply(swing, rotations.upperChest, clavicles[side]);
}

/**
 * Writes the hips and the rotations of the vertebrae: the pelvis faces between head and shoulders, and each joint above
 * turns by a part of the rest.
 */
function placeSpine(
  state: FitTorsoState,
  { joints, frame, bones, deltaSeconds }: TorsoInput,
  { up: thoraxUp, line }: typeof thorax,
): void {
  const { pose } = state;
  const { head, headJoint } = frame;
  const { hips, chest, neck, rotations } = pose;
  hangHips(state, add(joints.hips, unleaned.moved, spine.hips), frame.bodyTurn, bones.lowerBackLength, deltaSeconds);
  const lowerBackUp = normalise(subtract(chest, hips, spine.up), up, spine.up);
  const pelvisLine = normalise(lerp(line, headingRight, torsoLimits.pelvisToHead, spine.pelvis), line, spine.pelvis);
  alignDirections(bones.lowerBack, lowerBackUp, pelvisLine, rotations.hips);
  lerp(pelvisLine, line, spineToShoulders, spine.vertebra);
  alignDirections(bones.lowerBack, lowerBackUp, spine.vertebra, rotations.spine);
  lerp(pelvisLine, line, torsoLimits.chestToShoulders, spine.vertebra);
  alignDirections(bones.thorax, thoraxUp, spine.vertebra, rotations.chest);
  lerp(line, rotate(head.orientation, right, spine.vertebra), 0.5, spine.vertebra);
  alignDirections(bones.neck, subtract(headJoint, neck, spine.up), spine.vertebra, rotations.neck);
}

/**
 * Writes the hips at `lowerBack` [m] from the chest joint, towards the estimate, never below the floor. The direction
 * is rate-limited (hipsTurnSpeed, relative to the body's turn) because it is ill-defined when the estimate is close to
 * the chest joint, or directly below a chest joint that is too low.
 */
function hangHips(
  { known, pose, towardsHips: towards }: FitTorsoState,
  estimate: Vec3,
  bodyTurn: Quat,
  lowerBack: number,
  deltaSeconds: number,
): void {
  const { chest, hips } = pose;
  const most = known ? hipsTurnSpeed * Math.max(deltaSeconds, 0) : Number.POSITIVE_INFINITY;
  const before = rotate(bodyTurn, towards, hipsBefore);
  normalise(subtract(estimate, chest, hips), down, hips);
  setVec3(towards, hips.x, 0, hips.z);
  turnTowards(hips, before, 1, most);
  addScaled(chest, hips, lowerBack, hips);
  const lowest = Math.min(lowestHips, chest.y + lowerBack);
  if (hips.y < lowest) {
    const drop = clamp(chest.y - lowest, -lowerBack, lowerBack);
    const aside = Math.sqrt(lowerBack * lowerBack - drop * drop);
    setVec3(before, before.x, 0, before.z);
    normalise(before, backward, before);
    turnTowards(normalise(towards, before, towards), before, 1, most);
    setVec3(hips, chest.x + towards.x * aside, chest.y - drop, chest.z + towards.z * aside);
  }
  normalise(subtract(hips, chest, towards), down, towards);
}

export function resetFitTorso(state: FitTorsoState): void {
  state.known = false;
}
