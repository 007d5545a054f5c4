import type { UpperBodyPose } from '../body/avatar-pose';
import type { JointName, Side } from '../body/joints';
import { type Skeleton, sideSign, wristFromHandBone } from '../body/skeleton';
import { solveTwoBones } from '../body/two-bone-ik';
import { clamp, dampedShare, smoothstep } from '../math/damper';
import type { Pose } from '../math/pose';
import {
  alignDirections,
  between,
  conjugate,
  fromAxes,
  fromAxisAngle,
  limitAngle,
  multiply,
  type Quat,
  rotate,
  swingTwist,
  twistAngle,
} from '../math/quat';
import {
  add,
  addScaled,
  cross,
  distance,
  dot,
  length,
  lerp,
  normalise,
  reject,
  right,
  scale,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../math/vec3';
import { headingOf } from '../tracking/heading';
import type { JointPositions } from './joint-positions';

/** What is known of one frame, floor frame: head and hands as they are, the six joints as somebody estimates them. */
export interface Estimate {
  readonly head: Pose<'floor'>;
  readonly leftHand: EstimatedHand;
  readonly rightHand: EstimatedHand;
  readonly joints: JointPositions;
}

/**
 * A wrist, floor frame. trust in [0, 1]: how far the trunk goes after it where the arm alone is too short; left out: all the way. Not
 * seen: no further than it went before the hand was lost.
 */
export type EstimatedHand = Pose<'floor'> & { readonly trust?: number; readonly seen?: boolean };

/** What one avatar's arms remember from frame to frame, so that no elbow flips. Chest frame. */
export interface ArmMemory {
  pole: Vec3;
  /** Unwrapped angle [rad] by which the hand is turned about the forearm. */
  twist: number;
}

export interface ReconstructionMemory {
  left: ArmMemory | null;
  right: ArmMemory | null;
  /** From the left to the right shoulder, unit, floor frame. */
  shoulderLine: Vec3 | null;
  /** By how much [m] the hands were out of reach when they were last seen. */
  readonly missing: Record<Side, number>;
}

export const emptyMemory = (): ReconstructionMemory => ({
  left: null,
  right: null,
  shoulderLine: null,
  missing: { left: 0, right: 0 },
});

interface TrunkLimits {
  /** How far the collarbone swings from rest [rad]. */
  readonly clavicle: number;
  /** How far the neck bends from its rest against the thorax [rad]. */
  readonly neck: number;
}
/** 35° and 60°. */
const anatomy: TrunkLimits = { clavicle: 0.61, neck: 1.05 };
/** For the one frame in fifty thousand whose wrist lies further away than that: the hand on the controller comes first. */
const extreme: TrunkLimits = { clavicle: 1.2, neck: 1.8 };
/** How far a wrist bends against the forearm [rad]: 90°, the extreme of flexion. */
const wristLimit = Math.PI / 2;
/** An elbow circles the line from shoulder to wrist at most this fast [rad/s]; a punch's elbow does 10. */
const swivelSpeed = 14;
/** Elbow estimates nearer to the arm's line than this [m] say little about the side it points to. */
const unsurePole = 0.04;
/** The trunk as an ellipse across [share of the thorax's length]: half width and half depth, skin and elbow included. */
const trunkHalfWidth = 1.2;
const trunkHalfDepth = 0.85;

/** Shoulders turn at most this fast [rad/s]; a pirouette's do 12. */
const trunkSpeed = 12;
/** Longest half-life [s] of the way that the shoulders' line follows, where their estimates lie so close that it says little. */
const vagueLineHalfLife = 0.15;
/** Shoulders nearer to each other than this say nothing, further apart than that all [share of their distance at rest]. */
const [vagueShoulders, sureShoulders] = [0.2, 0.7];

/** The shoulders' line of this frame from the way between their targets. */
type LineFollower = (between: Vec3, fallback: Vec3) => Vec3;

interface Torso {
  readonly shoulderLine: Vec3;
  readonly hips: Vec3;
  readonly chest: Vec3;
  readonly neck: Vec3;
  readonly rotations: Readonly<Record<'hips' | 'spine' | 'chest' | 'upperChest' | 'neck', Quat>>;
}

/**
 * Joints to rotations, as the paper's section 3.5: neck from the head, the shoulders' x-axis, pelvis and spine from both, the
 * elbow by the plane of shoulder, elbow and wrist and the law of cosines. Head and hands come out exactly where they were
 * tracked, bones keep their lengths: the estimate chooses directions, the skeleton does the rest. A wrist that the trunk cannot
 * follow leaves a straight arm pointing at it.
 */
export function reconstructOrientations(
  estimate: Estimate,
  skeleton: Skeleton,
  memory: ReconstructionMemory,
  deltaSeconds: number,
): UpperBodyPose {
  const { head } = estimate;
  const headJoint = subtract(head.position, rotate(head.orientation, skeleton.eyesInHead));
  const reach = reachOf(skeleton);
  const followLine = lineFollower(skeleton, memory.shoulderLine, deltaSeconds);

  // The trunk leans and turns after hands that the arms alone cannot reach. Overshoot: collarbone and neck take part of the way.
  let shoulderTargets = { left: estimate.joints.leftUpperArm, right: estimate.joints.rightUpperArm };
  let torso = placeTorso(head, headJoint, shoulderTargets, estimate.joints, skeleton, anatomy, followLine);
  let shoulders = placeShoulders(torso, shoulderTargets, skeleton, anatomy);
  // A guessed hand does not bend the trunk: what it is out of reach by stays so, as far as the hand is not trusted.
  const outOfReach = (side: Side): number => {
    const { position, trust = 1, seen = true } = wristOf(estimate, side);
    const missing = Math.max(distance(position, shoulders[side].position) - reach, 0);
    if (!seen) return Math.max(missing - trust * memory.missing[side], 0);
    memory.missing[side] = trust * missing;
    return (1 - trust) * missing;
  };
  const given = { left: outOfReach('left'), right: outOfReach('right') };
  for (let pass = 0; pass < reachPasses; pass++) {
    const limits = pass < anatomicalPasses ? anatomy : extreme;
    const pull = (side: Side): Vec3 | null => {
      const toWrist = subtract(wristOf(estimate, side).position, shoulders[side].position);
      const missing = length(toWrist) - reach - given[side];
      return missing > 1e-5 ? scale(normalise(toWrist), missing * 1.3) : null;
    };
    const left = pull('left');
    const rightPull = pull('right');
    if (!left && !rightPull) break;
    shoulderTargets = {
      left: left ? add(shoulderTargets.left, left) : shoulderTargets.left,
      right: rightPull ? add(shoulderTargets.right, rightPull) : shoulderTargets.right,
    };
    torso = placeTorso(head, headJoint, shoulderTargets, estimate.joints, skeleton, limits, followLine);
    shoulders = placeShoulders(torso, shoulderTargets, skeleton, limits);
  }

  memory.shoulderLine = torso.shoulderLine;

  const leftArm = placeArm('left', estimate, torso, shoulders.left, skeleton, memory, deltaSeconds);
  const rightArm = placeArm('right', estimate, torso, shoulders.right, skeleton, memory, deltaSeconds);
  const r = torso.rotations;
  const local = (parent: Quat, child: Quat): Quat => multiply(conjugate(parent), child);
  const localRotations: Record<JointName, Quat> = {
    hips: r.hips,
    spine: local(r.hips, r.spine),
    chest: local(r.spine, r.chest),
    upperChest: local(r.chest, r.upperChest),
    neck: local(r.upperChest, r.neck),
    head: local(r.neck, head.orientation),
    leftShoulder: local(r.upperChest, shoulders.left.orientation),
    leftUpperArm: local(shoulders.left.orientation, leftArm.upperArm),
    leftLowerArm: local(leftArm.upperArm, leftArm.lowerArm),
    leftHand: local(leftArm.lowerArm, leftArm.hand),
    rightShoulder: local(r.upperChest, shoulders.right.orientation),
    rightUpperArm: local(shoulders.right.orientation, rightArm.upperArm),
    rightLowerArm: local(rightArm.upperArm, rightArm.lowerArm),
    rightHand: local(rightArm.lowerArm, rightArm.hand),
  };
  return { hipsPosition: torso.hips, localRotations };
}

const reachPasses = 20;
const anatomicalPasses = 8;

const wristOf = (estimate: Estimate, side: Side): EstimatedHand =>
  side === 'left' ? estimate.leftHand : estimate.rightHand;

/** Shoulder to wrist of a straight arm [m], a hair less, so that the elbow keeps a side. */
const reachOf = ({ restOffsets }: Skeleton): number =>
  (length(restOffsets.rightLowerArm) + length(restOffsets.rightHand)) * (1 - 1e-5);

/** Follows the shoulders' line: never faster than `trunkSpeed`, and slowly where the shoulders are estimated close together. */
function lineFollower({ restOffsets }: Skeleton, before: Vec3 | null, deltaSeconds: number): LineFollower {
  const width = 2 * (restOffsets.rightShoulder.x + restOffsets.rightUpperArm.x);
  return (between, fallback) => {
    const wanted = normalise(between, before ?? fallback);
    if (!before) return wanted;
    const sure = smoothstep(vagueShoulders, sureShoulders, length(between) / width);
    const angle = Math.atan2(length(cross(before, wanted)), dot(before, wanted));
    const way = Math.min(
      angle * dampedShare(vagueLineHalfLife * (1 - sure), deltaSeconds),
      trunkSpeed * Math.max(deltaSeconds, 0),
    );
    if (angle - way < 1e-9) return wanted;
    const aside = normalise(cross(cross(before, wanted), before), fallback);
    return normalise(addScaled(scale(before, Math.cos(way)), aside, Math.sin(way)));
  };
}

/** Neck, chest joint and hips on their bones' lengths below the head, and how each vertebra turns. */
function placeTorso(
  head: Pose<'floor'>,
  headJoint: Vec3,
  shoulderTargets: { readonly left: Vec3; readonly right: Vec3 },
  joints: JointPositions,
  { restOffsets }: Skeleton,
  limits: TrunkLimits,
  followLine: LineFollower,
): Torso {
  const headingRight = rotate(headingOf(head.orientation), right);
  const middle = lerp(shoulderTargets.left, shoulderTargets.right, 0.5);
  const shoulderLine = followLine(subtract(shoulderTargets.right, shoulderTargets.left), headingRight);
  const thoraxRest = add(restOffsets.upperChest, restOffsets.neck);
  const thoraxLength = length(thoraxRest);

  // The neck's base that these shoulders hang from, then brought onto the neck's length from the head.
  const roughUp = normalise(subtract(middle, joints.chest), up);
  const roughChest = alignDirections(thoraxRest, right, roughUp, shoulderLine);
  const shouldersFromNeck = subtract(
    scale(
      add(
        add(restOffsets.leftShoulder, restOffsets.leftUpperArm),
        add(restOffsets.rightShoulder, restOffsets.rightUpperArm),
      ),
      0.5,
    ),
    restOffsets.neck,
  );
  const impliedNeck = subtract(middle, rotate(roughChest, shouldersFromNeck));
  const neckRest = rotate(roughChest, restOffsets.head);
  const neckBend = limitAngle(between(neckRest, subtract(headJoint, impliedNeck)), limits.neck);
  const neck = subtract(headJoint, rotate(neckBend, neckRest));

  // Chest joint and hips follow half of what the neck was moved by.
  const moved = scale(subtract(neck, impliedNeck), 0.5);
  const thoraxUp = normalise(subtract(neck, add(joints.chest, moved)), roughUp);
  const chest = addScaled(neck, thoraxUp, -thoraxLength);
  const lowerBackRest = add(restOffsets.spine, restOffsets.chest);
  const hips = hangHips(chest, add(joints.hips, moved), length(lowerBackRest));
  const lowerBackUp = normalise(subtract(chest, hips), up);

  // The pelvis faces between head and shoulders; each joint above turns a part of the way to the shoulder line.
  const pelvisLine = normalise(lerp(shoulderLine, headingRight, 0.35), shoulderLine);
  const headRight = rotate(head.orientation, right);
  return {
    shoulderLine,
    hips,
    chest,
    neck,
    rotations: {
      hips: alignDirections(lowerBackRest, right, lowerBackUp, pelvisLine),
      spine: alignDirections(lowerBackRest, right, lowerBackUp, lerp(pelvisLine, shoulderLine, 0.35)),
      chest: alignDirections(thoraxRest, right, thoraxUp, lerp(pelvisLine, shoulderLine, 0.7)),
      upperChest: alignDirections(thoraxRest, right, thoraxUp, shoulderLine),
      neck: alignDirections(restOffsets.head, right, subtract(headJoint, neck), lerp(shoulderLine, headRight, 0.5)),
    },
  };
}

/** The hips at `lowerBack` [m] from the chest joint towards their target, but never below the floor. */
function hangHips(chest: Vec3, target: Vec3, lowerBack: number): Vec3 {
  const hips = addScaled(chest, normalise(subtract(target, chest), vec3(0, -1, 0)), lowerBack);
  const lowest = Math.min(lowestHips, chest.y + lowerBack);
  if (hips.y >= lowest) return hips;
  const drop = clamp(chest.y - lowest, -lowerBack, lowerBack);
  const aside = Math.sqrt(lowerBack * lowerBack - drop * drop);
  const horizontal = normalise({ ...subtract(hips, chest), y: 0 }, vec3(0, 0, 1));
  return vec3(chest.x + horizontal.x * aside, chest.y - drop, chest.z + horizontal.z * aside);
}

/** The height [m] of the hip joints' middle when sitting on the floor. */
const lowestHips = 0.09;

function placeShoulders(
  torso: Torso,
  targets: { readonly left: Vec3; readonly right: Vec3 },
  skeleton: Skeleton,
  limits: TrunkLimits,
): Record<Side, Pose<'floor'>> {
  const place = (side: Side): Pose<'floor'> => {
    const { upperChest } = torso.rotations;
    const offsets = skeleton.restOffsets;
    const root = add(
      torso.chest,
      add(
        rotate(torso.rotations.chest, offsets.upperChest),
        rotate(upperChest, side === 'left' ? offsets.leftShoulder : offsets.rightShoulder),
      ),
    );
    const rest = rotate(upperChest, side === 'left' ? offsets.leftUpperArm : offsets.rightUpperArm);
    const swing = limitAngle(between(rest, subtract(targets[side], root)), limits.clavicle);
    return { position: add(root, rotate(swing, rest)), orientation: multiply(swing, upperChest) };
  };
  return { left: place('left'), right: place('right') };
}

interface ArmRotations {
  readonly upperArm: Quat;
  readonly lowerArm: Quat;
  readonly hand: Quat;
}

function placeArm(
  side: Side,
  estimate: Estimate,
  torso: Torso,
  shoulder: Pose<'floor'>,
  { restOffsets }: Skeleton,
  memory: ReconstructionMemory,
  deltaSeconds: number,
): ArmRotations {
  const sigma = sideSign(side);
  const wrist = wristOf(estimate, side);
  const upperArm = length(side === 'left' ? restOffsets.leftLowerArm : restOffsets.rightLowerArm);
  const forearm = length(side === 'left' ? restOffsets.leftHand : restOffsets.rightHand);
  const floorFromChest = torso.rotations.upperChest;
  const downAndBack = rotate(floorFromChest, normalise(vec3(0.2 * sigma, -1, 0.5)));
  const fallbacks: [Vec3, Vec3] = [downAndBack, rotate(floorFromChest, vec3(0, 0, 1))];

  const pole = steadyPole(side, estimate, floorFromChest, wrist.position, memory, deltaSeconds, fallbacks);
  const solve = (direction: Vec3) =>
    solveTwoBones(shoulder.position, wrist.position, upperArm, forearm, direction, fallbacks);
  const solution = clearOfTrunk(sigma, torso, solve, solve(pole));

  // The plane of shoulder, elbow and wrist: its normal is the elbow's hinge, +Y at rest on the right, −Y on the left.
  const along = vec3(sigma, 0, 0);
  const hingeAtRest = vec3(0, sigma, 0);
  const hinge = cross(solution.pole, solution.axis);
  const upperArmRotation = alignDirections(along, hingeAtRest, subtract(solution.elbow, shoulder.position), hinge);
  const untwisted = alignDirections(along, hingeAtRest, subtract(wrist.position, solution.elbow), hinge);

  // The hand follows the tracked wrist; the forearm takes half of its turn, so that no wrist is wrung.
  const hand = multiply(wrist.orientation, wristFromHandBone[side]);
  const handInForearm = multiply(conjugate(untwisted), hand);
  const raw = twistAngle(swingTwist(handInForearm, along).twist, along);
  const previous = memory[side]?.twist ?? 0;
  const unwrapped = raw + 2 * Math.PI * Math.round((previous - raw) / (2 * Math.PI));
  const twist = Math.abs(unwrapped) > 1.25 * Math.PI ? raw : unwrapped;
  const lowerArm = multiply(untwisted, fromAxisAngle(along, clamp(twist, -Math.PI, Math.PI) / 2));
  memory[side] = { pole: rotate(conjugate(floorFromChest), solution.pole), twist };

  const bend = swingTwist(multiply(conjugate(lowerArm), hand), along);
  const limited = multiply(limitAngle(bend.swing, wristLimit), limitAngle(bend.twist, wristLimit));
  return { upperArm: upperArmRotation, lowerArm, hand: multiply(lowerArm, limited) };
}

/** Where the estimated elbow points from its own arm's line, steadied: an unsure estimate keeps the side it had. */
function steadyPole(
  side: Side,
  { joints }: Estimate,
  floorFromChest: Quat,
  wrist: Vec3,
  memory: ReconstructionMemory,
  deltaSeconds: number,
  [fallback]: readonly [Vec3, Vec3],
): Vec3 {
  const shoulder = side === 'left' ? joints.leftUpperArm : joints.rightUpperArm;
  const elbow = side === 'left' ? joints.leftLowerArm : joints.rightLowerArm;
  const axis = normalise(subtract(wrist, shoulder), fallback);
  const estimated = reject(subtract(elbow, shoulder), axis);
  const before = memory[side];
  const kept = before ? rotate(floorFromChest, before.pole) : fallback;
  const keptAcross = normalise(reject(kept, axis), reject(fallback, axis));
  const sure = smoothstep(0, unsurePole, length(estimated));
  // An unsure estimate is followed by its share of the way every 1/60 s, at any frame rate.
  const share = before ? 1 - (1 - sure) ** (60 * Math.max(deltaSeconds, 0)) : sure;
  const wanted = normalise(lerp(keptAcross, normalise(estimated, keptAcross), share), keptAcross);
  if (!before) return wanted;
  const angle = Math.atan2(dot(cross(keptAcross, wanted), axis), dot(keptAcross, wanted));
  const most = swivelSpeed * Math.max(deltaSeconds, 0);
  return Math.abs(angle) <= most ? wanted : rotate(fromAxisAngle(axis, Math.sign(angle) * most), keptAcross);
}

/** The same arm with its elbow swung outward as far as it takes to leave the trunk. */
function clearOfTrunk<Solution extends { readonly elbow: Vec3; readonly axis: Vec3; readonly pole: Vec3 }>(
  sigma: number,
  torso: Torso,
  solve: (pole: Vec3) => Solution,
  solution: Solution,
): Solution {
  const unit = distance(torso.neck, torso.chest);
  const axisUp = normalise(subtract(torso.neck, torso.hips), up);
  const side = normalise(reject(rotate(torso.rotations.upperChest, right), axisUp), right);
  const frame = conjugate(fromAxes(side, axisUp, cross(side, axisUp)));
  const height = distance(torso.neck, torso.hips);
  /** Below 1 inside the trunk. */
  const clearance = (elbow: Vec3): number => {
    const p = rotate(frame, subtract(elbow, torso.hips));
    if (p.y < -0.5 * unit || p.y > height) return 2;
    return Math.hypot(p.x / (trunkHalfWidth * unit), p.z / (trunkHalfDepth * unit));
  };
  if (clearance(solution.elbow) >= 1) return solution;
  const outward = reject(scale(side, sigma), solution.axis);
  if (length(outward) < 1e-3) return solution;
  const goal = normalise(outward);
  const angle = Math.atan2(dot(cross(solution.pole, goal), solution.axis), dot(solution.pole, goal));
  const swung = (share: number): Solution => solve(rotate(fromAxisAngle(solution.axis, angle * share), solution.pole));
  let inside = 0;
  let outside = 1;
  for (let step = 0; step < 10; step++) {
    const half = (inside + outside) / 2;
    if (clearance(swung(half).elbow) >= 1) outside = half;
    else inside = half;
  }
  return swung(outside);
}
