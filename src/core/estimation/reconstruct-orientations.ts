import type { UpperBodyPose } from '../body/avatar-pose';
import type { JointName, Side } from '../body/joints';
import { type Skeleton, sideSign, wristFromHandBone } from '../body/skeleton';
import { elbowFlexion, solveTwoBones, type TwoBoneSolution } from '../body/two-bone-ik';
import { clamp, dampedShare, smoothstep } from '../math/damper';
import type { Pose } from '../math/pose';
import {
  alignDirections,
  between,
  conjugate,
  fromAxes,
  fromAxisAngle,
  identity,
  limitAngle,
  multiply,
  type Quat,
  rotate,
  slerp,
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
import type { HandWay } from '../tracking/hand-continuity';
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
 * seen: no further than it went before the hand was lost. way: the arm is on its way from where it was drawn to the way's goal.
 */
export type EstimatedHand = Pose<'floor'> & {
  readonly trust?: number;
  readonly seen?: boolean;
  readonly way?: HandWay;
};

/** What one avatar's arms remember from frame to frame, so that no elbow flips. Chest frame. */
export interface ArmMemory {
  /** From the shoulder to the wrist, unit. */
  readonly axis: Vec3;
  /** Where the elbow points from that line, unit. */
  readonly pole: Vec3;
  /** Unwrapped angle [rad] by which the hand is turned about the forearm. */
  readonly twist: number;
  /** How much of it the forearm takes [rad]. */
  readonly forearmTwist: number;
  /** The upper arm as it was drawn. */
  readonly upperArm: Quat;
  /** The elbow's flexion as it was drawn [rad]. */
  readonly flexion: number;
  /** What was drawn beyond where the hand belongs when its way began: drawn = turn·goal, flexion + goal's. */
  readonly detached: { readonly since: number; readonly turn: Quat; readonly flexion: number } | null;
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
const swivelSpeed = 12;
/** The same where the hand is a guess. */
const guessedSwivelSpeed = 5;
/** Longest half-life [s] of the way that an elbow follows, where its estimate says little about the side it points to. */
const unsureHalfLife = 0.35;
/** An estimated elbow nearer to the arm's line than this [m] says little: the arm is nearly straight. */
const unsurePole = 0.04;
/** A hand nearer to the shoulder than the first says nothing about the line between them, further than the second all [arm lengths]. */
const [handAtShoulder, handAway] = [0.1, 0.3];
/** A forearm turns at most this fast [rad/s] about itself; a quick pronation does 15. */
const forearmSpeed = 20;
/** The trunk as a capsule, skin and elbow included: half width, half depth, and height of the caps [share of the thorax's length]. */
const trunkHalfWidth = 1.2;
const trunkHalfDepth = 0.85;
const trunkCap = 0.5;

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

const reachPasses = 32;
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

  // Chest joint and hips follow half of what the neck was moved by; a hand far out of reach does not throw them about.
  const shift = subtract(neck, impliedNeck);
  const furthest = length(restOffsets.head);
  const moved = scale(shift, 0.5 * Math.min(1, furthest / Math.max(length(shift), 1e-9)));
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

/** So near to its reach [arm lengths] an arm whose hand is a guess begins to stay bent; on a way back in the share that is left. */
const softBend = 0.06;

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

  const { way } = wrist;
  const before = memory[side];
  const departs = way !== undefined && before?.detached?.since !== way.since;
  const target = way
    ? softTarget(shoulder.position, way.goal.position, softBend * (wrist.seen ? way.left : 1), upperArm + forearm)
    : wrist.position;
  const solve = (direction: Vec3) =>
    solveTwoBones(shoulder.position, target, upperArm, forearm, direction, fallbacks);
  const circle = elbowCircle(solve(downAndBack), shoulder.position);
  const pole = steadyPole(
    sigma,
    wantedPole(side, estimate, circle, fallbacks),
    circle,
    torso,
    floorFromChest,
    // A new way's elbow need not be near the one before: what lies between is detached, below.
    departs ? null : before,
    wrist.trust ?? 1,
    upperArm + forearm,
    deltaSeconds,
  );
  const solution = solve(pole);

  // The plane of shoulder, elbow and wrist: its normal is the elbow's hinge, +Y at rest on the right, −Y on the left.
  const along = vec3(sigma, 0, 0);
  const hingeAtRest = vec3(0, sigma, 0);
  const hinge = cross(solution.pole, solution.axis);
  let upperArmRotation = alignDirections(along, hingeAtRest, subtract(solution.elbow, shoulder.position), hinge);
  let untwisted = alignDirections(along, hingeAtRest, subtract(target, solution.elbow), hinge);

  // On its way the arm is drawn between: turned and bent by what is left of the difference to where it was drawn.
  const toChest = conjugate(floorFromChest);
  let upperArmInChest = multiply(toChest, upperArmRotation);
  let flexion = elbowFlexion(upperArm, forearm, distance(shoulder.position, target));
  let detached: ArmMemory['detached'] = null;
  if (way) {
    detached =
      before && !departs
        ? before.detached
        : {
            since: way.since,
            turn: before ? multiply(before.upperArm, conjugate(upperArmInChest)) : identity,
            flexion: before ? before.flexion - flexion : 0,
          };
    upperArmInChest = multiply(slerp(identity, detached?.turn ?? identity, way.left), upperArmInChest);
    flexion += (detached?.flexion ?? 0) * way.left;
    upperArmRotation = multiply(floorFromChest, upperArmInChest);
    untwisted = multiply(upperArmRotation, fromAxisAngle(hingeAtRest, flexion));
  }

  // The hand follows the tracked wrist; the forearm takes half of its turn, so that no wrist is wrung.
  const hand = multiply(wrist.orientation, wristFromHandBone[side]);
  const handInForearm = multiply(conjugate(untwisted), hand);
  const raw = twistAngle(swingTwist(handInForearm, along).twist, along);
  const previous = before?.twist ?? 0;
  const unwrapped = raw + 2 * Math.PI * Math.round((previous - raw) / (2 * Math.PI));
  const twist = Math.abs(unwrapped) > 1.25 * Math.PI ? raw : unwrapped;
  const share = clamp(twist, -Math.PI, Math.PI) / 2;
  const turn = forearmSpeed * Math.max(deltaSeconds, 0);
  const forearmTwist = before ? clamp(share, before.forearmTwist - turn, before.forearmTwist + turn) : share;
  const lowerArm = multiply(untwisted, fromAxisAngle(along, forearmTwist));
  memory[side] = {
    axis: rotate(toChest, solution.axis),
    pole: rotate(toChest, solution.pole),
    twist,
    forearmTwist,
    upperArm: upperArmInChest,
    flexion,
    detached,
  };

  const bend = swingTwist(multiply(conjugate(lowerArm), hand), along);
  const limited = multiply(limitAngle(bend.swing, wristLimit), limitAngle(bend.twist, wristLimit));
  return { upperArm: upperArmRotation, lowerArm, hand: multiply(lowerArm, limited) };
}

/**
 * Where to reach for a place [m from the shoulder, arm's length `arm`]: nearer as it comes within `soft` arm lengths of the arm's reach,
 * so that no arm snaps straight after a hand that nobody sees.
 */
function softTarget(shoulder: Vec3, place: Vec3, soft: number, arm: number): Vec3 {
  const far = distance(shoulder, place);
  const near = arm * (1 - soft);
  if (soft <= 0 || far <= near) return place;
  const reach = arm - soft * arm * Math.exp((near - far) / (soft * arm));
  return addScaled(shoulder, subtract(place, shoulder), reach / far);
}

/** All places of an elbow: a circle about the line from shoulder to wrist. */
interface ElbowCircle {
  readonly centre: Vec3;
  /** From shoulder to wrist, unit. */
  readonly axis: Vec3;
  readonly radius: number;
  /** From shoulder to wrist [m], as far as the arm reaches. */
  readonly span: number;
}

function elbowCircle({ elbow, axis, pole }: TwoBoneSolution, shoulder: Vec3): ElbowCircle {
  const radius = dot(subtract(elbow, shoulder), pole);
  const centre = addScaled(elbow, pole, -radius);
  return { centre, axis, radius, span: 2 * distance(centre, shoulder) };
}

/** Where the estimated elbow points from its own arm's line, and how sure that is, in [0, 1]. */
function wantedPole(
  side: Side,
  { joints, leftHand, rightHand }: Estimate,
  { axis }: ElbowCircle,
  fallbacks: readonly [Vec3, Vec3],
): { readonly direction: Vec3; readonly sure: number } {
  const shoulder = side === 'left' ? joints.leftUpperArm : joints.rightUpperArm;
  const elbow = side === 'left' ? joints.leftLowerArm : joints.rightLowerArm;
  const wrist = side === 'left' ? leftHand : rightHand;
  const ownAxis = normalise(subtract(wrist.position, shoulder), axis);
  const aside = reject(subtract(elbow, shoulder), ownAxis);
  let across = reject(rotate(between(ownAxis, axis), aside), axis);
  for (const fallback of fallbacks) if (length(across) < 1e-6) across = reject(fallback, axis);
  return { direction: normalise(across), sure: smoothstep(0, unsurePole, length(aside)) };
}

/**
 * Where the elbow points now: after its estimate by way of the trunk's outside, with bounded speed, and slowly where the estimate says
 * little. The side it had is carried along as the arm moves. The first frame takes the estimate, out of the trunk.
 */
function steadyPole(
  sigma: number,
  goal: { readonly direction: Vec3; readonly sure: number },
  circle: ElbowCircle,
  torso: Torso,
  floorFromChest: Quat,
  before: ArmMemory | null,
  trust: number,
  arm: number,
  deltaSeconds: number,
): Vec3 {
  const { axis } = circle;
  // Angles about the arm's line, from the direction that leads away from the trunk.
  const outside = reject(rotate(floorFromChest, vec3(sigma, 0, 0)), axis);
  const zero = normalise(length(outside) > 1e-3 ? outside : reject(rotate(floorFromChest, vec3(0, 0, 1)), axis));
  const quarter = cross(axis, zero);
  const angleOf = (direction: Vec3): number => Math.atan2(dot(direction, quarter), dot(direction, zero));
  const poleAt = (angle: number): Vec3 => addScaled(scale(zero, Math.cos(angle)), quarter, Math.sin(angle));

  const free = freeSwivel(circle, zero, quarter, torso);
  const estimated = angleOf(goal.direction);
  const wanted = free ? nearestWithin(estimated, free) : estimated;
  if (!before) return poleAt(wanted);

  const carried = rotate(between(rotate(floorFromChest, before.axis), axis), rotate(floorFromChest, before.pole));
  const kept = angleOf(carried);
  const inside = free !== null && nearestWithin(kept, free) !== kept;
  // Free to move both ways round, the elbow takes the shorter; else the one that does not lead through the trunk.
  const way = free && !inside ? wanted - kept : Math.atan2(Math.sin(wanted - kept), Math.cos(wanted - kept));
  const sure = goal.sure * smoothstep(handAtShoulder * arm, handAway * arm, circle.span);
  const followed = inside ? way : way * dampedShare(unsureHalfLife * (1 - sure) ** 3, deltaSeconds);
  const most = (guessedSwivelSpeed + (swivelSpeed - guessedSwivelSpeed) * trust) * Math.max(deltaSeconds, 0);
  return poleAt(kept + clamp(followed, -most, most));
}

/** The angles of a range [low, high] around 0 nearest to one in (−π, π]. */
function nearestWithin(angle: number, [low, high]: readonly [number, number]): number {
  if (angle >= low && angle <= high) return angle;
  const beyond = (from: number) => Math.abs(Math.atan2(Math.sin(angle - from), Math.cos(angle - from)));
  return beyond(low) < beyond(high) ? low : high;
}

/** Angles are looked at in steps of this [rad], borders found to a sixty-fourth of it. */
const swivelStep = Math.PI / 18;

/** The swivel angles about the outside at which an elbow is clear of the trunk; null: at all. */
function freeSwivel(
  { centre, radius }: ElbowCircle,
  zero: Vec3,
  quarter: Vec3,
  torso: Torso,
): readonly [number, number] | null {
  const unit = distance(torso.neck, torso.chest);
  const axisUp = normalise(subtract(torso.neck, torso.hips), up);
  const side = normalise(reject(rotate(torso.rotations.upperChest, right), axisUp), right);
  const trunkFromFloor = conjugate(fromAxes(side, axisUp, cross(side, axisUp)));
  const height = distance(torso.neck, torso.hips);
  const [c, u, v] = [
    rotate(trunkFromFloor, subtract(centre, torso.hips)),
    rotate(trunkFromFloor, scale(zero, radius)),
    rotate(trunkFromFloor, scale(quarter, radius)),
  ];
  /** Below 1 inside the trunk. */
  const clearance = (angle: number): number => {
    const [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
    const y = c.y + u.y * cosine + v.y * sine;
    const x = (c.x + u.x * cosine + v.x * sine) / (trunkHalfWidth * unit);
    const z = (c.z + u.z * cosine + v.z * sine) / (trunkHalfDepth * unit);
    const beyond = (y - clamp(y, 0, height)) / (trunkCap * unit);
    return Math.sqrt(x * x + beyond * beyond + z * z);
  };
  /** From the outside on to one side: the last free angle. */
  const border = (way: number): number => {
    for (let step = 1; step <= 18; step++) {
      if (clearance(way * step * swivelStep) >= 1) continue;
      let [clear, blocked] = [(step - 1) * swivelStep, step * swivelStep];
      for (let halving = 0; halving < 6; halving++) {
        const middle = (clear + blocked) / 2;
        if (clearance(way * middle) >= 1) clear = middle;
        else blocked = middle;
      }
      return way * clear;
    }
    return way * Math.PI;
  };
  const high = border(1);
  const low = border(-1);
  return high === Math.PI && low === -Math.PI ? null : [low, high];
}
