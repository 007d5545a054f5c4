import { clavicleRest, clavicleRoot } from '../body/arm-rotations';
import limbLimits from '../body/limb-limits.json' with { type: 'json' };
import {
  elbowCircle,
  elbowOnCircle,
  type LimbBones,
  makeElbowCircle,
  poleAcross,
  softenedReach,
} from '../body/two-bone-ik';
import { clamp } from '../math/damper';
import { type MutablePose, makePose, type Pose } from '../math/pose';
import {
  conjugate,
  copyQuat,
  type MutableQuat,
  multiply,
  type Quat,
  quat,
  rotate,
  rotateInverse,
  rotationBetween,
  slerp,
} from '../math/quat';
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
  reject,
  right,
  scale,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from '../math/vec3';
import type { CompletedFrame, CompletedHand } from './complete-hands';
import limits from './kinematic-limits.json' with { type: 'json' };
import { confidenceBeyond, followPin, handOverSeconds, makePin, type Pin } from './pin';
import type { TrackedJoints } from './tracked-joints';
import { makeTrunkRotations, placeShoulder, type TorsoPose, trunkBones } from './trunk/fit-torso';
import type { TorsoBones } from './trunk/torso-bones';

/**
 * The fastest turn [rad/s] of the side to which the trunk bends, and the fastest way [m/s] of a joint by it: near
 * straight, and where a trunk folds, the side is ill-defined.
 */
const bendSpeed = 8;
const bendWay = 0.5;
/** The fastest change [m/s] of the back's bow: near straight, a millimetre of the hips gives it centimetres. */
const bowSpeed = 1;
/** The fraction of the pelvis's turn against its estimate that the spine joint takes; the rest is the chest joint's. */
const spineFraction = 0.5;

/** A pinned joint of the trunk, and the side to which the joint above it bends the trunk. */
interface TrunkPin extends Pin {
  /** Unit, frame of the pinned joint; zero: not known. */
  readonly bend: MutableVec3;
  /** The distance [m] of the joint above the hips from the line between its neighbours; null: not known. */
  bow: number | null;
}

interface PinTrunkState {
  /** False before the first frame. */
  known: boolean;
  readonly hips: TrunkPin;
  readonly chest: TrunkPin;
}

const makeTrunkPin = (): TrunkPin => ({ ...makePin(), bend: vec3(0, 0, 0), bow: null });

export const makePinTrunkState = (): PinTrunkState => ({ known: false, hips: makeTrunkPin(), chest: makeTrunkPin() });

/** A trunk before a pin moves it; floor frame. */
interface TrunkBefore extends Pick<TorsoPose, 'neck' | 'chest' | 'hips' | 'rotations'> {}

const makeTrunkBefore = (): TrunkBefore => ({
  neck: vec3(0, 0, 0),
  chest: vec3(0, 0, 0),
  hips: vec3(0, 0, 0),
  rotations: makeTrunkRotations(),
});

/** The trunk as it was fitted, and as the current pin found it. */
const fitted = makeTrunkBefore();
const before = makeTrunkBefore();
const jointBefore: MutablePose<'floor'> = makePose();
// Scratch of one bone.
const circle = makeElbowCircle();
const limb = { upper: Number.NaN, lower: Number.NaN };
const fallbackPoles: readonly [MutableVec3, MutableVec3] = [vec3(0, 0, 0), vec3(0, 0, 0)];
const pole = vec3(0, 0, 0);
const poleBefore = vec3(0, 0, 0);
const across = vec3(0, 0, 0);
const bone = vec3(0, 0, 0);
const boneBefore = vec3(0, 0, 0);
const spine = vec3(0, 0, 0);
const shoulder = vec3(0, 0, 0);
const swing = quat(0, 0, 0, 1);
const relative = quat(0, 0, 0, 1);
const inverse = quat(0, 0, 0, 1);

/**
 * Stage 5, between trunk and arms: moves the trunk onto the joints that trackers pin. Bones keep their lengths and the
 * head its place. The chest joint is where its tracker places it; the thorax turns with it and leads to a neck on its
 * bone. The hips are where their tracker places them and turned like it; the lower back bends to meet the thorax. Where
 * both cannot hold, the chest's tracker gives way, then the turn of the hips, then their place. Changes nothing without
 * trackers.
 */
export function pinTrunk(
  state: PinTrunkState,
  torso: TorsoPose,
  tracked: TrackedJoints,
  frame: CompletedFrame,
  bones: TorsoBones,
  deltaSeconds: number,
): void {
  const seconds = Math.max(deltaSeconds, 0);
  const step = state.known ? seconds / handOverSeconds : 1;
  state.known = true;
  if (!tracked.hips && !tracked.chest && state.hips.fraction === 0 && state.chest.fraction === 0) return;
  copyTrunk(torso, fitted);
  const { headJoint } = frame;
  const chestReach = bones.neckLength + bones.thoraxLength;
  const chestConfidence = confidenceOf(tracked.chest, headJoint, chestReach);
  const chestWeight = followPin(state.chest, jointOf(torso, 'chest'), tracked.chest, chestConfidence, step);
  if (chestWeight > 0) {
    copyTrunk(torso, before);
    moveChest(torso, state.chest, headJoint, bones, seconds);
    mixTrunk(torso, headJoint, bones, chestWeight);
  }
  const hipsConfidence = confidenceOf(tracked.hips, headJoint, chestReach + bones.lowerBackLength);
  const hipsWeight = followPin(state.hips, jointOf(torso, 'hips'), tracked.hips, hipsConfidence, step);
  if (hipsWeight > 0) {
    copyTrunk(torso, before);
    moveHips(torso, state.hips, headJoint, bones, seconds);
    mixTrunk(torso, headJoint, bones, hipsWeight);
  }
  if (chestWeight === 0 && hipsWeight === 0) return;
  carryShoulder('left', torso, frame.leftHand, bones);
  carryShoulder('right', torso, frame.rightHand, bones);
}

export function resetPinTrunk(state: PinTrunkState): void {
  state.known = false;
  for (const pin of [state.hips, state.chest]) {
    pin.fraction = 0;
    setVec3(pin.bend, 0, 0, 0);
    pin.bow = null;
  }
}

const confidenceOf = (joint: Pose<'floor'> | null, headJoint: Vec3, reach: number): number =>
  joint ? confidenceBeyond(distance(joint.position, headJoint) - reach) : 0;

function copyTrunk({ neck, chest, hips, rotations }: TrunkBefore, target: TrunkBefore): void {
  copyVec3(neck, target.neck);
  copyVec3(chest, target.chest);
  copyVec3(hips, target.hips);
  for (const bone of trunkBones) copyQuat(rotations[bone], target.rotations[bone]);
}

function jointOf(torso: TorsoPose, joint: 'hips' | 'chest'): Pose<'floor'> {
  copyVec3(torso[joint], jointBefore.position);
  copyQuat(torso.rotations[joint], jointBefore.orientation);
  return jointBefore;
}

/** Turns the bones only a part of the way from where the pin found them, and hangs them from the head. */
function mixTrunk(
  { neck, chest, hips, rotations }: TorsoPose,
  headJoint: Vec3,
  bones: TorsoBones,
  weight: number,
): void {
  if (weight === 1) return;
  const { restOffsets } = bones.skeleton;
  for (const name of trunkBones) slerp(before.rotations[name], rotations[name], weight, rotations[name]);
  subtract(headJoint, rotate(rotations.neck, restOffsets.head, bone), neck);
  subtract(neck, rotate(rotations.upperChest, restOffsets.neck, bone), chest);
  subtract(chest, rotate(rotations.chest, restOffsets.upperChest, bone), chest);
  subtract(chest, rotate(rotations.spine, restOffsets.chest, bone), hips);
  subtract(hips, rotate(rotations.hips, restOffsets.spine, bone), hips);
}

/** The chest joint at its target, as nearly as neck and thorax reach; the lower back is carried along. */
function moveChest(torso: TorsoPose, pin: TrunkPin, headJoint: Vec3, bones: TorsoBones, seconds: number): void {
  const { target } = pin;
  const { neck, chest, hips, rotations } = torso;
  limb.upper = bones.neckLength;
  limb.lower = bones.thoraxLength;
  elbowCircle(headJoint, target.position, limb, down, circle);
  add(target.position, rotate(target.orientation, bones.thorax.main, bone), neck);
  bendTowards(neck, pin, seconds);
  addScaled(headJoint, circle.axis, circle.span, chest);
  add(hips, subtract(chest, before.chest, bone), hips);

  multiply(conjugate(before.rotations.chest, inverse), before.rotations.upperChest, relative);
  rotate(target.orientation, bones.thorax.main, boneBefore);
  copyQuat(target.orientation, rotations.chest);
  swingBone(rotations.chest, boneBefore, subtract(neck, chest, bone));
  multiply(rotations.chest, relative, rotations.upperChest);
  turnNeck(torso, headJoint);
}

/** The hips at their target, as nearly as the trunk reaches; chest joint and neck move no further than they must. */
function moveHips(torso: TorsoPose, pin: TrunkPin, headJoint: Vec3, bones: TorsoBones, seconds: number): void {
  const { target } = pin;
  const { neck, chest, hips, rotations } = torso;
  const { restOffsets } = bones.skeleton;
  const pelvisLength = length(restOffsets.spine);
  const backLength = length(restOffsets.chest);
  const backReach = bones.thoraxLength + backLength;
  const spineReach = bones.neckLength + backReach;

  const far = distance(target.position, headJoint);
  const furthest = (spineReach + pelvisLength) * limbLimits.straightest;
  lerp(headJoint, target.position, Math.min(1, furthest / Math.max(far, 1e-9)), hips);
  rotate(target.orientation, restOffsets.spine, boneBefore);
  add(hips, boneBefore, spine);
  bringTo(spine, hips, pelvisLength, headJoint, Math.min(distance(spine, headJoint), spineReach), target.orientation);
  limb.upper = bones.thoraxLength;
  limb.lower = backLength;
  elbowCircle(neck, spine, limb, down, circle);
  const span = spanOf(bowAfter(pin, circle.radius, seconds), limb);
  bringTo(neck, headJoint, bones.neckLength, spine, span, target.orientation);
  subtract(spine, hips, bone);
  swingBone(copyQuat(target.orientation, rotations.hips), boneBefore, bone);

  limb.upper = bones.thoraxLength;
  limb.lower = backLength;
  pin.bow = elbowCircle(neck, spine, limb, down, circle).radius;
  bendTowards(chest, pin, seconds);
  addScaled(neck, circle.axis, circle.span, spine);
  subtract(spine, bone, hips);

  // The spine joint as it was turned against the hips, and as it was turned: between both.
  multiply(conjugate(before.rotations.hips, inverse), before.rotations.spine, relative);
  multiply(rotations.hips, relative, relative);
  slerp(before.rotations.spine, relative, spineFraction, rotations.spine);
  rotate(rotations.spine, restOffsets.chest, boneBefore);
  swingBone(rotations.spine, boneBefore, subtract(chest, spine, bone));
  subtract(before.neck, before.chest, boneBefore);
  subtract(neck, chest, bone);
  swingBone(rotations.chest, boneBefore, bone);
  swingBone(rotations.upperChest, boneBefore, bone);
  turnNeck(torso, headJoint);
}

/** Returns the bow [m] after a frame: that of the places, as far as it can change in `seconds`. */
const bowAfter = ({ bow }: TrunkPin, wanted: number, seconds: number): number =>
  bow === null ? wanted : clamp(wanted, bow - bowSpeed * seconds, bow + bowSpeed * seconds);

/** Returns the distance [m] between the ends of two bones that meet this far [m] off the line between. */
const spanOf = (bow: number, { upper, lower }: LimbBones): number =>
  Math.sqrt(Math.max(upper * upper - bow * bow, 0)) + Math.sqrt(Math.max(lower * lower - bow * bow, 0));

/** Moves a joint along its sphere about `root` to this distance [m] from `goal`, as nearly as its bone can. */
function bringTo(joint: MutableVec3, root: Vec3, boneLength: number, goal: Vec3, wanted: number, facing: Quat): void {
  if (Math.abs(distance(joint, goal) - wanted) < 1e-9) return;
  limb.upper = boneLength;
  limb.lower = wanted;
  elbowCircle(root, goal, limb, down, circle);
  placeOnCircle(joint, facing);
}

/** Moves a joint to the nearest point of the circle. */
function placeOnCircle(joint: MutableVec3, facing: Quat): void {
  rotate(facing, backward, fallbackPoles[0]);
  rotate(facing, right, fallbackPoles[1]);
  subtract(joint, circle.centre, pole);
  elbowOnCircle(circle, poleAcross(circle.axis, pole, fallbackPoles, pole), joint);
}

/**
 * Moves the joint above a pinned one onto the circle, turned from its side before no further than in `seconds`. A joint
 * inside the circle is drawn to the back, because near the axis its side is undefined: a trunk that folds gets round.
 */
function bendTowards(joint: MutableVec3, { target, bend }: TrunkPin, seconds: number): void {
  const { axis, centre, radius } = circle;
  rotate(target.orientation, backward, fallbackPoles[0]);
  rotate(target.orientation, right, fallbackPoles[1]);
  reject(subtract(joint, centre, pole), axis, pole);
  addScaled(pole, fallbackPoles[0], Math.max(radius - length(pole), 0), pole);
  poleAcross(axis, pole, fallbackPoles, pole);
  if (dot(bend, bend) > 0) {
    poleAcross(axis, rotate(target.orientation, bend, poleBefore), fallbackPoles, poleBefore);
    cross(axis, poleBefore, across);
    const most = Math.min(bendSpeed, bendWay / Math.max(radius, 1e-9)) * seconds;
    const turn = clamp(Math.atan2(dot(across, pole), dot(poleBefore, pole)), -most, most);
    addScaled(scale(poleBefore, Math.cos(turn), pole), across, Math.sin(turn), pole);
  }
  rotateInverse(target.orientation, pole, bend);
  elbowOnCircle(circle, pole, joint);
}

/** Turns a bone by the smallest rotation from one direction to the other. */
const swingBone = (rotation: MutableQuat, from: Vec3, to: Vec3): MutableQuat =>
  multiply(rotationBetween(from, to, swing), rotation, rotation);

/** Turns the neck's bone from where its base was to where it is. */
function turnNeck({ neck, rotations }: TorsoPose, headJoint: Vec3): void {
  swingBone(rotations.neck, subtract(headJoint, before.neck, boneBefore), subtract(headJoint, neck, bone));
}

/** Carries a shoulder along with the thorax; the clavicle swings after a hand that is then out of reach. */
function carryShoulder(side: Side, torso: TorsoPose, hand: CompletedHand, bones: TorsoBones): void {
  multiply(torso.rotations.upperChest, conjugate(fitted.rotations.upperChest, inverse), relative);
  subtract(torso.shoulders[side], fitted.neck, shoulder);
  add(torso.neck, rotate(relative, shoulder, shoulder), shoulder);
  if (hand.source === 'tracked') {
    const { skeleton } = bones;
    const root = clavicleRoot(side, torso.neck, torso.rotations.upperChest, skeleton, bone);
    const wanted = softenedReach(distance(shoulder, hand.goal.position), bones.reach);
    bringTo(
      shoulder,
      root,
      length(clavicleRest(side, skeleton)),
      hand.goal.position,
      wanted,
      torso.rotations.upperChest,
    );
  }
  placeShoulder(side, torso, bones, shoulder, limits.torsoExtreme.clavicleSwing);
}
