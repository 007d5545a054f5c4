import type { UpperBodyPose } from '../body/avatar-pose';
import type { JointName, Side } from '../body/joints';
import { type Skeleton, sideSign, wristFromHandBone } from '../body/skeleton';
import { solveTwoBones, type TwoBoneSolution } from '../body/two-bone-ik';
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
import type { HandWay } from '../tracking/hand-continuity';
import { headingOf } from '../tracking/heading';
import { alongArc, directionArc } from '../tracking/shoulder-arc';
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
 * seen: no further than it went before the hand was lost. way: where the arm goes instead, from where it was drawn.
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
  /** As it was drawn, and where in the floor frame. */
  readonly drawn: DrawnArm;
  readonly joints: ElbowAndWrist;
  /** When its hand was sent where it belongs now [s]. */
  readonly since: number | null;
  /** Null: it is where it belongs. */
  readonly way: ArmWay | null;
}

/** The directions of an arm's bones, unit, and of the elbow's hinge, floor frame: who whirls about does not fling an arm on its way. */
interface DrawnArm {
  readonly upperArm: Vec3;
  readonly forearm: Vec3;
  readonly hinge: Vec3;
}

type Bones = Pick<DrawnArm, 'upperArm' | 'forearm'>;

interface ElbowAndWrist {
  readonly elbow: Vec3;
  readonly wrist: Vec3;
}

/** An arm that is not yet where its hand belongs. */
interface ArmWay {
  /** Where elbow and wrist belonged in the frame before, floor frame; null: it sets out. */
  readonly goal: ElbowAndWrist | null;
  /** To rest, rather than back to a hand that is seen. */
  readonly rests: boolean;
  /** The furthest that it was away, and how far it is of that. */
  readonly metres: number;
  readonly left: number;
  /** Beyond what its goal moves by itself [m/s]. */
  readonly speed: number;
}

export interface ReconstructionMemory {
  left: ArmMemory | null;
  right: ArmMemory | null;
  /** From the left to the right shoulder, unit, floor frame. */
  shoulderLine: Vec3 | null;
  /** By how much [m] the hands were out of reach when they were last seen. */
  readonly missing: Record<Side, number>;
  /** Where the trunk's joints were estimated about the head joint, floor axes; null: nowhere yet. */
  trunk: TrunkJoints | null;
}

export const emptyMemory = (): ReconstructionMemory => ({
  left: null,
  right: null,
  shoulderLine: null,
  missing: { left: 0, right: 0 },
  trunk: null,
});

type TrunkJoints = Pick<JointPositions, 'leftUpperArm' | 'rightUpperArm' | 'chest' | 'hips'>;

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

/** Estimated hips, chest and shoulders move about the head at most this fast [m/s]; 999 of 1000 frames of the motion trained on are slower. */
const trunkJointSpeed = 2.5;
/** The same where the head lies on its side, so that its heading says nothing of the body's. */
const vagueTrunkSpeed = 0.6;
/** The horizontal part of the head's right axis at which its heading begins to say something, and says all. */
const [vagueHead, sureHead] = [0.35, 0.7];

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
  const trunk = steadyTrunk(estimate.joints, head, headJoint, memory, deltaSeconds);
  let shoulderTargets = { left: trunk.leftUpperArm, right: trunk.rightUpperArm };
  let torso = placeTorso(head, headJoint, shoulderTargets, trunk, skeleton, anatomy, followLine);
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
    torso = placeTorso(head, headJoint, shoulderTargets, trunk, skeleton, limits, followLine);
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

/** The trunk's joints as estimated, but about the head no faster than a body moves: a head on its side changes its heading at once. */
function steadyTrunk(
  { leftUpperArm, rightUpperArm, chest, hips }: JointPositions,
  head: Pose<'floor'>,
  headJoint: Vec3,
  memory: ReconstructionMemory,
  deltaSeconds: number,
): TrunkJoints {
  const before = memory.trunk;
  const side = rotate(head.orientation, right);
  const defined = smoothstep(vagueHead, sureHead, Math.hypot(side.x, side.z));
  const most = (vagueTrunkSpeed + (trunkJointSpeed - vagueTrunkSpeed) * defined) * Math.max(deltaSeconds, 0);
  const follow = (joint: keyof TrunkJoints, estimated: Vec3): Vec3 => {
    const now = subtract(estimated, headJoint);
    if (!before) return now;
    const way = subtract(now, before[joint]);
    return length(way) <= most ? now : addScaled(before[joint], normalise(way), most);
  };
  const about = {
    leftUpperArm: follow('leftUpperArm', leftUpperArm),
    rightUpperArm: follow('rightUpperArm', rightUpperArm),
    chest: follow('chest', chest),
    hips: follow('hips', hips),
  };
  memory.trunk = about;
  return {
    leftUpperArm: add(headJoint, about.leftUpperArm),
    rightUpperArm: add(headJoint, about.rightUpperArm),
    chest: add(headJoint, about.chest),
    hips: add(headJoint, about.hips),
  };
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

/** An arm takes about so long [s] to rest and back at least, and goes at most this fast [m/s]: 2.8 and 3.75 cm in a frame at 60 Hz. */
const [restSeconds, returnSeconds] = [0.3, 0.2];
const [restSpeed, returnSpeed] = [1.7, 2.25];
/** The share of the shortest time in which it gets up to its speed, and down from it. */
const wayRamp = 0.2;
/** A way is measured in so many steps. */
const waySteps = 8;
const stillness = { metres: 0, left: 1, speed: 0 };
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

  const before = memory[side];
  const toChest = conjugate(floorFromChest);
  const sent = wrist.way;
  const departs = sent !== undefined && before !== null && before.since !== sent.since;
  const setOut: ArmWay | null = departs && before ? { goal: null, rests: sent.rests, ...stillness } : null;
  const way = setOut ?? before?.way ?? null;
  const left = way?.left ?? 0;
  const target = sent
    ? softTarget(shoulder.position, sent.goal.position, softBend * (sent.rests ? 1 : left * left), upperArm + forearm)
    : wrist.position;
  const solve = (direction: Vec3) => solveTwoBones(shoulder.position, target, upperArm, forearm, direction, fallbacks);
  const circle = elbowCircle(solve(downAndBack), shoulder.position);
  const pole = steadyPole(
    sigma,
    wantedPole(side, estimate, circle, fallbacks),
    circle,
    torso,
    floorFromChest,
    // Where the hand is sent the elbow need not be near where it was: the way there is the arm's.
    departs ? null : before,
    Math.min(wrist.trust ?? 1, 1 - left),
    upperArm + forearm,
    deltaSeconds,
  );
  const solution = solve(pole);
  const belongs: DrawnArm = {
    upperArm: normalise(subtract(solution.elbow, shoulder.position)),
    forearm: normalise(subtract(target, solution.elbow)),
    // The plane of shoulder, elbow and wrist: its normal is the elbow's hinge, +Y at rest on the right, −Y on the left.
    hinge: cross(solution.pole, solution.axis),
  };
  const jointsOf = ({ upperArm: upper, forearm: fore }: Bones): ElbowAndWrist => {
    const elbow = addScaled(shoulder.position, upper, upperArm);
    return { elbow, wrist: addScaled(elbow, fore, forearm) };
  };
  const { drawn, way: onward } =
    way && before
      ? approach(
          before,
          belongs,
          way,
          sent?.goal.position ?? target,
          sent?.age ?? Number.POSITIVE_INFINITY,
          rotate(floorFromChest, normalise(vec3(sigma, -0.2, -1))),
          jointsOf,
          deltaSeconds,
        )
      : { drawn: belongs, way: null };

  const along = vec3(sigma, 0, 0);
  const turnOf = (bone: Vec3): Quat => alignDirections(along, vec3(0, sigma, 0), bone, drawn.hinge);
  const upperArmRotation = turnOf(drawn.upperArm);
  const untwisted = turnOf(drawn.forearm);

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
    drawn,
    joints: jointsOf(drawn),
    since: sent?.since ?? null,
    way: onward,
  };

  const bend = swingTwist(multiply(conjugate(lowerArm), hand), along);
  const limited = multiply(limitAngle(bend.swing, wristLimit), limitAngle(bend.twist, wristLimit));
  return { upperArm: upperArmRotation, lowerArm, hand: multiply(lowerArm, limited) };
}

/**
 * One frame of an arm's way from where it was drawn to where its hand belongs, along arcs about shoulder and elbow. Neither elbow nor
 * wrist goes further than the hand's goal itself went in this frame and what the way's speed allows beyond that.
 */
function approach(
  before: ArmMemory,
  to: DrawnArm,
  way: ArmWay,
  place: Vec3,
  age: number,
  outside: Vec3,
  jointsOf: (bones: Bones) => ElbowAndWrist,
  deltaSeconds: number,
): { readonly drawn: DrawnArm; readonly way: ArmWay | null } {
  const from = before.drawn;
  const arcs = {
    upperArm: directionArc(from.upperArm, to.upperArm, outside),
    forearm: directionArc(from.forearm, to.forearm, outside),
  };
  const at = (share: number): Bones => ({
    upperArm: rotate(alongArc(arcs.upperArm, share), from.upperArm),
    forearm: rotate(alongArc(arcs.forearm, share), from.forearm),
  });
  const places = Array.from({ length: waySteps + 1 }, (_, step) => jointsOf(at(step / waySteps)));
  const metresOf = (joint: keyof ElbowAndWrist): number =>
    places.reduce((sum, next, step) => sum + distance(next[joint], (places[step - 1] ?? next)[joint]), 0);
  const toGo = Math.max(metresOf('elbow'), metresOf('wrist'));

  const metres = Math.max(way.metres, toGo);
  const [shortest, fastest] = way.rests ? [restSeconds, restSpeed] : [returnSeconds, returnSpeed];
  const top = Math.min(fastest, metres / (shortest * (1 - wayRamp)));
  const acceleration = top / (shortest * wayRamp);
  const speed = Math.min(way.speed + acceleration * deltaSeconds, top, Math.sqrt(2 * acceleration * toGo));

  // What the hand itself went, not what an arm that does not reach it goes with its shoulder.
  const goal = { elbow: jointsOf(to).elbow, wrist: place };
  const beyond = speed * Math.max(deltaSeconds, 0);
  const carried = places[0] ?? before.joints;
  const wristWay =
    beyond + (way.goal ? distance(way.goal.wrist, goal.wrist) : distance(before.joints.wrist, carried.wrist));
  const elbowWay =
    beyond + (way.goal ? distance(way.goal.elbow, goal.elbow) : distance(before.joints.elbow, carried.elbow));
  const limits = {
    wrist: wristWay,
    elbow: Math.min(elbowWay, beyond + (1 - 0.6 * smoothstep(0.15, 0.6, metres)) * (wristWay - beyond)),
  };
  /** By how much [m] this share of the way would be too far for one frame. */
  const excess = (share: number): number => {
    const next = jointsOf(at(share));
    return Math.max(
      distance(before.joints.elbow, next.elbow) - limits.elbow,
      distance(before.joints.wrist, next.wrist) - limits.wrist,
    );
  };
  const share = furthestWithin(excess);
  // As long as a return takes, an arm that is there already keeps from snapping straight.
  if (share === 1 && toGo <= beyond + 1e-6 && age >= shortest) return { drawn: to, way: null };
  const next = at(share);
  const left = (toGo * (1 - share)) / Math.max(metres, 1e-9);
  const unbent = lerp(to.hinge, rotate(between(from.upperArm, next.upperArm), from.hinge), left);
  return {
    drawn: { ...next, hinge: normalise(addScaled(cross(next.upperArm, next.forearm), unbent, 0.1), to.hinge) },
    way: { ...way, goal, metres, left, speed },
  };
}

/** The largest share in [0, 1] that does not exceed what is allowed; where every one does, the one that does so least. */
function furthestWithin(excess: (share: number) => number): number {
  if (excess(1) <= 0) return 1;
  let best = { share: 0, excess: excess(0) };
  for (let step = 1; step < waySteps; step++) {
    const now = { share: step / waySteps, excess: excess(step / waySteps) };
    if (now.excess <= 0 || now.excess < best.excess) best = now;
  }
  if (best.excess > 0) return best.share;
  let [within, beyond] = [best.share, best.share + 1 / waySteps];
  for (let halving = 0; halving < 6; halving++) {
    const middle = (within + beyond) / 2;
    if (excess(middle) <= 0) within = middle;
    else beyond = middle;
  }
  return within;
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
