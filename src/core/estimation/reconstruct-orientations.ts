import type { UpperBodyPose } from '../body/avatar-pose';
import type { JointName, Side } from '../body/joints';
import { type Skeleton, sideSign, wristFromHandBone } from '../body/skeleton';
import { clamp, dampedShare, smoothstep } from '../math/damper';
import type { Pose } from '../math/pose';
import {
  alignDirections,
  between,
  conjugate,
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
  right,
  scale,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../math/vec3';
import type { HandWay } from '../tracking/hand-continuity';
import { headingOf } from '../tracking/heading';
import { type Arm, type ArmCourse, type DrawnArm, goOn, jointsOf, softTarget, wayOf } from './arm-way';
import { bendElbow, type ElbowSide, type EstimatedArm } from './elbow-side';
import type { JointPositions } from './joint-positions';
import { steadyTrunk, type TrunkJoints, trunkUnder } from './steady-trunk';

/** What is known of one frame, floor frame: head and hands as they are, the six joints as somebody estimates them. */
export interface Estimate {
  readonly head: Pose<'floor'>;
  readonly leftHand: EstimatedHand;
  readonly rightHand: EstimatedHand;
  readonly joints: JointPositions;
}

/**
 * A wrist, floor frame. trust in [0, 1]: how far the trunk goes after it where the arm alone is too short; left out: all the way. Not
 * seen: no further than it went before the hand was lost. way: where the arm goes instead, from where it was drawn.
 */
export type EstimatedHand = Pose<'floor'> & {
  readonly trust?: number;
  readonly seen?: boolean;
  readonly way?: HandWay;
};

/** What one avatar's arm remembers from frame to frame. */
export interface ArmMemory extends ArmCourse, ElbowSide {
  /** Unwrapped angle [rad] by which the hand is turned about the forearm. */
  readonly twist: number;
  /** How much of it the forearm takes [rad]. */
  readonly forearmTwist: number;
}

/** A hand that the arm alone does not reach. */
interface Lean {
  /** By how much [m], and how much of it the trunk makes up for. */
  readonly missing: number;
  readonly made: number;
}

export interface ReconstructionMemory {
  left: ArmMemory | null;
  right: ArmMemory | null;
  /** From the left to the right shoulder, unit, floor frame. */
  shoulderLine: Vec3 | null;
  readonly lean: Record<Side, Lean | null>;
  /** Where the trunk's joints were estimated about the head joint, floor axes; null: nowhere yet. */
  trunk: TrunkJoints | null;
}

export const emptyMemory = (): ReconstructionMemory => ({
  left: null,
  right: null,
  shoulderLine: null,
  lean: { left: null, right: null },
  trunk: null,
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
/** A forearm turns at most this fast [rad/s] about itself; a quick pronation does 15. */
const forearmSpeed = 20;
/** A trunk leans after a hand that comes back, and straightens after one that is lost, at most this fast [m/s]. */
const leanSpeed = 0.6;
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
  memory.trunk = steadyTrunk(estimate.joints, head, headJoint, memory.trunk, deltaSeconds);
  const trunk = trunkUnder(headJoint, memory.trunk);
  let shoulderTargets = { left: trunk.leftUpperArm, right: trunk.rightUpperArm };
  let torso = placeTorso(head, headJoint, shoulderTargets, trunk, skeleton, anatomy, followLine);
  let shoulders = placeShoulders(torso, shoulderTargets, skeleton, anatomy);
  const outOfReach = (side: Side): number => {
    const wrist = wristOf(estimate, side);
    const missing = Math.max(distance(wrist.position, shoulders[side].position) - reach, 0);
    const lean = leanAfter(wrist, missing, memory.lean[side], deltaSeconds);
    memory.lean[side] = lean;
    return missing - lean.made;
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
    torso = placeTorso(head, headJoint, shoulderTargets, trunk, skeleton, limits, followLine);
    shoulders = placeShoulders(torso, shoulderTargets, skeleton, limits);
  }

  memory.shoulderLine = torso.shoulderLine;

  const leftArm = placeArm('left', estimate, torso, shoulders.left.position, skeleton, memory, deltaSeconds);
  const rightArm = placeArm('right', estimate, torso, shoulders.right.position, skeleton, memory, deltaSeconds);
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

/** How far the trunk goes after a hand: not after a guess, and after one that is on its way back no faster than people lean. */
function leanAfter(
  { seen = true, trust = 1 }: EstimatedHand,
  missing: number,
  before: Lean | null,
  deltaSeconds: number,
): Lean {
  if (!before) return { missing, made: seen ? missing : 0 };
  const further = leanSpeed * Math.max(deltaSeconds, 0);
  const gone = trust < 1 ? 0 : Math.max(missing - before.missing, 0);
  const most = seen ? before.made + gone + further : Math.max(before.made - further, 0);
  return { missing, made: Math.min(missing, most) };
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
  joints: TrunkJoints,
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

interface ArmRotations {
  readonly upperArm: Quat;
  readonly lowerArm: Quat;
  readonly hand: Quat;
}

/** An arm that hangs from its shoulder: to its wrist, or on its way there; hand as tracked, forearm turned half as far. */
function placeArm(
  side: Side,
  estimate: Estimate,
  torso: Torso,
  shoulder: Vec3,
  { restOffsets }: Skeleton,
  memory: ReconstructionMemory,
  deltaSeconds: number,
): ArmRotations {
  const sigma = sideSign(side);
  const before = memory[side];
  const wrist = wristOf(estimate, side);
  const arm: Arm = {
    shoulder,
    upperArm: length(side === 'left' ? restOffsets.leftLowerArm : restOffsets.rightLowerArm),
    forearm: length(side === 'left' ? restOffsets.leftHand : restOffsets.rightHand),
  };

  const way = wayOf(before, wrist.way);
  const setsOut = way !== null && way.goal === null;
  const target = wrist.way ? softTarget(arm, wrist.way, way) : wrist.position;
  const bent = bendElbow(
    side,
    arm,
    target,
    estimatedArm(side, estimate),
    torso,
    // Where the hand is sent the elbow need not be near where it was: the way there is the arm's.
    setsOut ? null : before,
    Math.min(wrist.trust ?? 1, 1 - (way?.left ?? 0)),
    deltaSeconds,
  );
  const belongs: DrawnArm = {
    upperArm: normalise(subtract(bent.elbow, shoulder)),
    forearm: normalise(subtract(target, bent.elbow)),
    // The plane of shoulder, elbow and wrist: its normal is the elbow's hinge, +Y at rest on the right, −Y on the left.
    hinge: cross(bent.pole, bent.axis),
  };
  const { upperChest } = torso.rotations;
  const outside = rotate(upperChest, normalise(vec3(sigma, -0.2, -1)));
  const { drawn, way: onward } =
    before && way && wrist.way
      ? goOn(before, way, belongs, wrist.way, arm, outside, deltaSeconds)
      : { drawn: belongs, way: null };

  const along = vec3(sigma, 0, 0);
  const turnOf = (bone: Vec3): Quat => alignDirections(along, vec3(0, sigma, 0), bone, drawn.hinge);
  const hand = multiply(wrist.orientation, wristFromHandBone[side]);
  const { lowerArm, ...turned } = turnForearm(turnOf(drawn.forearm), hand, along, before, deltaSeconds);
  const toChest = conjugate(upperChest);
  memory[side] = {
    axis: rotate(toChest, bent.axis),
    pole: rotate(toChest, bent.pole),
    ...turned,
    drawn,
    joints: jointsOf(arm, drawn),
    since: wrist.way?.since ?? null,
    way: onward,
  };
  return { upperArm: turnOf(drawn.upperArm), lowerArm, hand: limitWrist(lowerArm, hand, along) };
}

/** Shoulder and elbow as they are estimated, and the wrist. */
function estimatedArm(side: Side, { joints, leftHand, rightHand }: Estimate): EstimatedArm {
  return side === 'left'
    ? { shoulder: joints.leftUpperArm, elbow: joints.leftLowerArm, wrist: leftHand.position }
    : { shoulder: joints.rightUpperArm, elbow: joints.rightLowerArm, wrist: rightHand.position };
}

/** The forearm takes half of the hand's turn about it, so that no wrist is wrung; all orientations in the floor frame. */
function turnForearm(
  untwisted: Quat,
  hand: Quat,
  along: Vec3,
  before: ArmMemory | null,
  deltaSeconds: number,
): { readonly lowerArm: Quat; readonly twist: number; readonly forearmTwist: number } {
  const handInForearm = multiply(conjugate(untwisted), hand);
  const raw = twistAngle(swingTwist(handInForearm, along).twist, along);
  const previous = before?.twist ?? 0;
  const unwrapped = raw + 2 * Math.PI * Math.round((previous - raw) / (2 * Math.PI));
  const twist = Math.abs(unwrapped) > 1.25 * Math.PI ? raw : unwrapped;
  const share = clamp(twist, -Math.PI, Math.PI) / 2;
  const most = forearmSpeed * Math.max(deltaSeconds, 0);
  const forearmTwist = before ? clamp(share, before.forearmTwist - most, before.forearmTwist + most) : share;
  return { lowerArm: multiply(untwisted, fromAxisAngle(along, forearmTwist)), twist, forearmTwist };
}

/** The hand as it is turned, but against the forearm no further than a wrist bends. */
function limitWrist(lowerArm: Quat, hand: Quat, along: Vec3): Quat {
  const { swing, twist } = swingTwist(multiply(conjugate(lowerArm), hand), along);
  return multiply(lowerArm, multiply(limitAngle(swing, wristLimit), limitAngle(twist, wristLimit)));
}
