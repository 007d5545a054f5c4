import { clavicleRest, clavicleRoot } from '../body/arm-rotations';
import limbLimits from '../body/limb-limits.json';
import type { Skeleton } from '../body/skeleton';
import { clamp, smoothingFactor, smoothstep } from '../math/damper';
import { alignDirections, limitAngle, type MutableQuat, multiply, quat, rotate, rotationBetween } from '../math/quat';
import type { Side } from '../math/side';
import {
  add,
  addScaled,
  backward,
  copyVec3,
  cross,
  distance,
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
} from '../math/vec3';
import { headingOf } from '../tracking/heading';
import type { CompletedFrame, CompletedHand } from './complete-hands';
import type { JointPositions } from './joint-positions';
import limits from './kinematic-limits.json';

const { torso: shares, reach: extreme } = limits;

/** A trunk leans after a hand that comes back, and straightens after one that is lost, at most this fast [m/s]. */
const leanSpeed = 0.6;
/** Shoulders turn at most this fast [rad/s]; a pirouette's do 12. */
const turnSpeed = 12;
/** Longest half-life [s] of the shoulders' line, where they are estimated so close together that it says little. */
const shoulderLineHalfLife = 0.15;
/** Shoulders nearer to each other than the first say nothing of their line, further apart than the second all [share of their distance at rest]. */
const [undefinedLine, definedLine] = [0.2, 0.7];
/** Hips that the floor keeps from hanging turn at most this fast about the chest joint [rad/s]: 2.5 cm in a frame at 60 Hz. */
const hipsTurnSpeed = 6;
/** Of the turn from the pelvis to the shoulders' line, in the lower back [1]. */
const spineToShoulders = 0.35;
/** The height [m] of the hip joints' middle when sitting on the floor. */
const lowestHips = 0.09;

const trunkBones = ['hips', 'spine', 'chest', 'upperChest', 'neck'] as const;

/** A trunk with its bones' lengths under the head, floor frame. */
export interface TorsoPose {
  readonly hips: MutableVec3;
  readonly chest: MutableVec3;
  readonly neck: MutableVec3;
  readonly rotations: Readonly<Record<(typeof trunkBones)[number], MutableQuat>>;
  readonly clavicles: Readonly<Record<Side, MutableQuat>>;
  readonly shoulders: Readonly<Record<Side, MutableVec3>>;
}

/** How a shoulder goes after a hand that the arm alone does not reach: from where it is estimated [m], floor frame. */
interface Lean {
  /** How far the skeleton keeps the shoulder from there already when it does not lean. */
  kept: number;
  /** As far as the hand is missed. */
  readonly wanted: MutableVec3;
  readonly wantedBefore: MutableVec3;
  /** As far as the trunk leans. */
  readonly offset: MutableVec3;
}

const makeLean = (): Lean => ({ kept: 0, wanted: vec3(0, 0, 0), wantedBefore: vec3(0, 0, 0), offset: vec3(0, 0, 0) });

export interface FitTorsoState {
  /** False before the first frame. */
  known: boolean;
  readonly pose: TorsoPose;
  /** From the left to the right shoulder, unit, floor frame: of this frame, and of the one before. */
  readonly shoulderLine: MutableVec3;
  readonly lineBefore: MutableVec3;
  /** From the chest joint to the hips, horizontal, unit, floor frame. */
  readonly towardsHips: MutableVec3;
  /** The hips are not yet where they lie or hang: they turn there. */
  hipsTurn: boolean;
  readonly lean: Readonly<Record<Side, Lean>>;
}

export const makeFitTorsoState = (): FitTorsoState => ({
  known: false,
  pose: {
    hips: vec3(0, 0, 0),
    chest: vec3(0, 0, 0),
    neck: vec3(0, 0, 0),
    rotations: {
      hips: quat(0, 0, 0, 1),
      spine: quat(0, 0, 0, 1),
      chest: quat(0, 0, 0, 1),
      upperChest: quat(0, 0, 0, 1),
      neck: quat(0, 0, 0, 1),
    },
    clavicles: { left: quat(0, 0, 0, 1), right: quat(0, 0, 0, 1) },
    shoulders: { left: vec3(0, 0, 0), right: vec3(0, 0, 0) },
  },
  shoulderLine: vec3(1, 0, 0),
  lineBefore: vec3(1, 0, 0),
  towardsHips: vec3(0, 0, 1),
  hipsTurn: false,
  lean: { left: makeLean(), right: makeLean() },
});

/** What the fitting of the torso needs of a skeleton, measured once. */
export interface TorsoBones {
  readonly skeleton: Skeleton;
  /** From chest joint to neck, and from hips to chest joint, at rest. */
  readonly thorax: Vec3;
  readonly thoraxLength: number;
  readonly lowerBack: Vec3;
  readonly lowerBackLength: number;
  readonly neckLength: number;
  /** From the neck to the middle of the shoulders, at rest. */
  readonly shouldersFromNeck: Vec3;
  readonly shoulderWidth: number;
  /** Shoulder to wrist of a straight arm [m], a hair less, so that the elbow keeps a side. */
  readonly reach: number;
  /** How far a shoulder leans after a hand at most [m], beyond how far it is kept from where it is estimated: as far as its clavicle is long. */
  readonly furthestLean: number;
}

export function torsoBones(skeleton: Skeleton): TorsoBones {
  const offsets = skeleton.restOffsets;
  const thorax = add(offsets.upperChest, offsets.neck);
  const lowerBack = add(offsets.spine, offsets.chest);
  const left = add(offsets.leftShoulder, offsets.leftUpperArm);
  const rightShoulder = add(offsets.rightShoulder, offsets.rightUpperArm);
  return {
    skeleton,
    thorax,
    thoraxLength: length(thorax),
    lowerBack,
    lowerBackLength: length(lowerBack),
    neckLength: length(offsets.head),
    shouldersFromNeck: subtract(lerp(left, rightShoulder, 0.5), offsets.neck),
    shoulderWidth: 2 * rightShoulder.x,
    reach: (length(offsets.rightLowerArm) + length(offsets.rightHand)) * limbLimits.straightest,
    furthestLean: length(offsets.rightUpperArm),
  };
}

/** What the torso of one frame is fitted to; floor frame. */
interface TorsoGoal {
  readonly joints: JointPositions;
  readonly frame: CompletedFrame;
  readonly bones: TorsoBones;
  readonly deltaSeconds: number;
}

/** Where the shoulders are to be, floor frame. */
const targets: Readonly<Record<Side, MutableVec3>> = { left: vec3(0, 0, 0), right: vec3(0, 0, 0) };
/** By how much the neck was moved onto its length from the head, the part of it that chest joint and hips follow. */
const moved = vec3(0, 0, 0);
const headingRight = vec3(0, 0, 0);
const thoraxUp = vec3(0, 0, 0);
const roughUp = vec3(0, 0, 0);
const a = vec3(0, 0, 0);
const b = vec3(0, 0, 0);
const c = vec3(0, 0, 0);
const rotation = quat(0, 0, 0, 1);
const swing = quat(0, 0, 0, 1);

/**
 * Stage 5, the trunk: neck, chest joint, hips and clavicles on their bones' lengths under the head, as nearly where they are
 * estimated as that lets them, leaning and turning after hands that the arms alone cannot reach.
 */
export function fitTorso(
  state: FitTorsoState,
  joints: JointPositions,
  frame: CompletedFrame,
  bones: TorsoBones,
  deltaSeconds: number,
): TorsoPose {
  const { pose, lean } = state;
  const goal: TorsoGoal = { joints, frame, bones, deltaSeconds };
  rotate(headingOf(frame.head.orientation, rotation), right, headingRight);
  setVec3(lean.left.wanted, 0, 0, 0);
  setVec3(lean.right.wanted, 0, 0, 0);
  placeThorax(state, goal, lean.left.wanted, lean.right.wanted);
  lean.left.kept = distance(pose.shoulders.left, joints.leftUpperArm);
  lean.right.kept = distance(pose.shoulders.right, joints.rightUpperArm);
  for (let pass = 0; pass < extreme.passes; pass++) {
    const pulledLeft = pull(lean.left, pose.shoulders.left, frame.leftHand, bones);
    const pulledRight = pull(lean.right, pose.shoulders.right, frame.rightHand, bones);
    if (!pulledLeft && !pulledRight) break;
    placeThorax(state, goal, lean.left.wanted, lean.right.wanted);
  }
  const leansLeft = followLean(lean.left, frame.leftHand, state.known, deltaSeconds);
  const leansRight = followLean(lean.right, frame.rightHand, state.known, deltaSeconds);
  if (!leansLeft || !leansRight) placeThorax(state, goal, lean.left.offset, lean.right.offset);
  placeSpine(state, goal);
  copyVec3(state.shoulderLine, state.lineBefore);
  state.known = true;
  return pose;
}

/**
 * Leans a shoulder further towards a hand that is out of the arm's reach; false: it is not, or the lean does not change any more. No
 * trunk goes after a guess.
 */
function pull(
  { wanted, kept }: Lean,
  shoulder: Vec3,
  { position, source }: CompletedHand,
  { reach, furthestLean }: TorsoBones,
): boolean {
  if (source !== 'tracked') return false;
  subtract(position, shoulder, a);
  const missing = Math.max(length(a) - reach, 0);
  copyVec3(wanted, b);
  addScaled(wanted, normalise(a, undefined, a), missing * shares.reachOvershoot, wanted);
  const leant = length(wanted);
  scale(wanted, softLimit(leant, kept + furthestLean, furthestLean / 2) / Math.max(leant, 1e-9), wanted);
  return distance(wanted, b) > 1e-5;
}

/** The value itself up to `soft` below the limit, from there on ever less of it, and never more than the limit. */
const softLimit = (value: number, limit: number, soft: number): number =>
  value <= limit - soft ? value : limit - soft * Math.exp((limit - soft - value) / soft);

/**
 * Leans as far as is wanted, but after a hand that was lost or has come back no faster than people do; then only what is wanted
 * anew is had at once. False: the lean is not yet what is wanted.
 */
function followLean(
  { wanted, wantedBefore, offset }: Lean,
  hand: CompletedHand,
  known: boolean,
  deltaSeconds: number,
): boolean {
  const anew = hand.source === 'tracked' && hand.confidence === 1 ? distance(wanted, wantedBefore) : 0;
  const most = known ? leanSpeed * Math.max(deltaSeconds, 0) + anew : Number.POSITIVE_INFINITY;
  copyVec3(wanted, wantedBefore);
  if (distance(wanted, offset) <= most) {
    copyVec3(wanted, offset);
    return true;
  }
  const far = distance(wanted, offset);
  lerp(offset, wanted, Math.min(1, most / far), offset);
  return false;
}

/**
 * The shoulders' line: never faster than `turnSpeed`, and slowly where the shoulders are estimated close together. Leans along it do
 * not turn it: shoulders that lean towards each other, after hands that cross, would come together and turn about.
 */
function followShoulderLine(state: FitTorsoState, goal: TorsoGoal, leanLeft: Vec3, leanRight: Vec3): void {
  const { shoulderLine: line, lineBefore: before, known } = state;
  const { joints, bones, deltaSeconds } = goal;
  subtract(joints.rightUpperArm, joints.leftUpperArm, a);
  const apart = length(a);
  normalise(a, headingRight, c);
  addScaled(a, reject(subtract(leanRight, leanLeft, b), c, b), 1, a);
  const wanted = normalise(a, known ? before : headingRight, line);
  if (!known) return;
  const confidence = smoothstep(undefinedLine, definedLine, apart / bones.shoulderWidth);
  const most = turnSpeed * Math.max(deltaSeconds, 0);
  turnTowards(before, wanted, smoothingFactor(shoulderLineHalfLife * (1 - confidence), deltaSeconds), most, line);
}

/** Turns a unit vector by a share of the angle to the wanted one, but by `most` [rad] at most; returns the angle [rad] that is left. */
function turnTowards(before: Vec3, wanted: Vec3, share: number, most: number, target: MutableVec3): number {
  const angle = Math.atan2(length(cross(before, wanted, b)), dot(before, wanted));
  const turn = Math.min(angle * share, most);
  if (angle - turn < 1e-9) {
    copyVec3(wanted, target);
    return 0;
  }
  normalise(cross(b, before, b), headingRight, b);
  scale(before, Math.cos(turn), target);
  normalise(addScaled(target, b, Math.sin(turn), target), before, target);
  return angle - turn;
}

/** Neck, chest joint, the upper chest's rotation and the shoulders, where these lean so far from where they are estimated. */
function placeThorax(state: FitTorsoState, goal: TorsoGoal, leanLeft: Vec3, leanRight: Vec3): void {
  const { joints, frame, bones } = goal;
  const { pose, shoulderLine } = state;
  const { upperChest } = pose.rotations;
  add(joints.leftUpperArm, leanLeft, targets.left);
  add(joints.rightUpperArm, leanRight, targets.right);
  followShoulderLine(state, goal, leanLeft, leanRight);
  const middle = lerp(targets.left, targets.right, 0.5, a);
  const leansLeft = Math.max(0, length(leanLeft) - state.lean.left.kept) / bones.furthestLean;
  const leansRight = Math.max(0, length(leanRight) - state.lean.right.kept) / bones.furthestLean;
  const neckBend = widened(shares.neckBend, extreme.neckBend, Math.max(leansLeft, leansRight));

  // The neck's base that these shoulders hang from, then brought onto the neck's length from the head.
  subtract(lerp(joints.leftUpperArm, joints.rightUpperArm, 0.5, b), joints.chest, b);
  normalise(keptAhead(b, subtract(middle, joints.chest, roughUp), roughUp), up, roughUp);
  const roughChest = alignDirections(bones.thorax, right, roughUp, shoulderLine, rotation);
  const impliedNeck = subtract(middle, rotate(roughChest, bones.shouldersFromNeck, b), a);
  const neckRest = rotate(roughChest, bones.skeleton.restOffsets.head, b);
  limitAngle(rotationBetween(neckRest, subtract(frame.headJoint, impliedNeck, c), swing), neckBend, swing);
  subtract(frame.headJoint, rotate(swing, neckRest, c), pose.neck);

  // Chest joint and hips follow a share of what the neck was moved by; a hand far out of reach does not throw them about.
  subtract(pose.neck, impliedNeck, moved);
  const far = length(moved);
  scale(moved, shares.neckShiftShare * Math.min(1, bones.neckLength / Math.max(far, 1e-9)), moved);
  subtract(pose.neck, add(joints.chest, moved, b), thoraxUp);
  normalise(thoraxUp, roughUp, thoraxUp);
  addScaled(pose.neck, thoraxUp, -bones.thoraxLength, pose.chest);
  alignDirections(bones.thorax, right, thoraxUp, shoulderLine, upperChest);
  placeShoulder('left', pose, bones, leansLeft);
  placeShoulder('right', pose, bones, leansRight);
}

/** Where a bone is drawn to, but at least half its length ahead along its rest: behind its joint the way it turns would flip over. */
function keptAhead(rest: Vec3, towards: Vec3, target: MutableVec3): MutableVec3 {
  const lacking = 0.5 - dot(rest, towards) / Math.max(dot(rest, rest), 1e-12);
  return addScaled(towards, rest, Math.max(lacking, 0), target);
}

/** A limit [rad] of a trunk that leans by this share of the furthest. */
const widened = (limit: number, widest: number, share: number): number => limit + (widest - limit) * share;

/** A shoulder on its clavicle, which swings towards its target. */
function placeShoulder(
  side: Side,
  { neck, rotations, clavicles, shoulders }: TorsoPose,
  { skeleton }: TorsoBones,
  leans: number,
): void {
  const root = clavicleRoot(side, neck, rotations.upperChest, skeleton, a);
  const rest = rotate(rotations.upperChest, clavicleRest(side, skeleton), b);
  const limit = widened(shares.clavicleSwing, extreme.clavicleSwing, leans);
  limitAngle(rotationBetween(rest, keptAhead(rest, subtract(targets[side], root, c), c), swing), limit, swing);
  add(root, rotate(swing, rest, b), shoulders[side]);
  multiply(swing, rotations.upperChest, clavicles[side]);
}

/** Hips, and how each vertebra turns: the pelvis faces between head and shoulders; each joint above turns a part of the rest. */
function placeSpine(state: FitTorsoState, { joints, frame, bones, deltaSeconds }: TorsoGoal): void {
  const { pose, shoulderLine } = state;
  const { head, headJoint } = frame;
  const { hips, chest, neck, rotations } = pose;
  hangHips(state, add(joints.hips, moved, a), bones.lowerBackLength, deltaSeconds);
  const lowerBackUp = normalise(subtract(chest, hips, a), up, a);
  const pelvisLine = normalise(lerp(shoulderLine, headingRight, shares.pelvisToHead, b), shoulderLine, b);
  alignDirections(bones.lowerBack, right, lowerBackUp, pelvisLine, rotations.hips);
  lerp(pelvisLine, shoulderLine, spineToShoulders, c);
  alignDirections(bones.lowerBack, right, lowerBackUp, c, rotations.spine);
  lerp(pelvisLine, shoulderLine, shares.chestToShoulders, c);
  alignDirections(bones.thorax, right, thoraxUp, c, rotations.chest);
  lerp(shoulderLine, rotate(head.orientation, right, a), 0.5, c);
  alignDirections(bones.skeleton.restOffsets.head, right, subtract(headJoint, neck, a), c, rotations.neck);
}

/**
 * The hips at `lowerBack` [m] from the chest joint towards their target, but never below the floor. Under a chest that is too low for
 * them to hang they lie aside, and a target almost below the chest hardly says where: they turn there with a limited speed, and go on
 * with it when they hang again until they have caught up.
 */
function hangHips(state: FitTorsoState, goal: Vec3, lowerBack: number, deltaSeconds: number): void {
  const { pose, towardsHips: towards } = state;
  const { chest, hips } = pose;
  subtract(goal, chest, hips);
  addScaled(chest, normalise(hips, down, hips), lowerBack, hips);
  const lowest = Math.min(lowestHips, chest.y + lowerBack);
  const before = copyVec3(state.known ? towards : backward, c);
  const wanted = normalise(setVec3(towards, hips.x - chest.x, 0, hips.z - chest.z), before, towards);
  const lie = hips.y < lowest;
  if (!lie && !state.hipsTurn) return;
  if (state.known) {
    const angle = turnTowards(before, wanted, 1, hipsTurnSpeed * Math.max(deltaSeconds, 0), towards);
    state.hipsTurn = angle > 0;
  }
  const drop = lie ? clamp(chest.y - lowest, -lowerBack, lowerBack) : chest.y - hips.y;
  const aside = Math.sqrt(lowerBack * lowerBack - drop * drop);
  setVec3(hips, chest.x + towards.x * aside, chest.y - drop, chest.z + towards.z * aside);
}

/** Forgets the past: the next frame is the first. */
export function resetFitTorso(state: FitTorsoState): void {
  state.known = false;
  state.hipsTurn = false;
}
