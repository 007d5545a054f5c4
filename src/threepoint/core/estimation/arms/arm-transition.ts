import type { LimbBones } from '../../body/two-bone-ik';
import { clamp } from '../../math/damper';
import { quat, rotate, rotationBetween } from '../../math/quat';
import {
  addScaled,
  copyVec3,
  cross,
  distance,
  dot,
  length,
  lerp,
  type MutableVec3,
  normalise,
  type Vec3,
  vec3,
} from '../../math/vec3';
import { advanceArc, alongArc, type DirectionArc, directionArc, makeDirectionArc, retargetArc } from './direction-arc';

/** The shortest transition [s]. */
const shortestSeconds = 0.2;
/**
 * The highest speed of elbow and wrist [m/s] in addition to the motion of their goals: 3.75 cm in a frame at 60 Hz. An
 * arm that would take longer than `hurrySeconds` moves evenly and as fast as necessary.
 */
const fastest = 2.25;
/** The fraction of the shortest duration that acceleration and deceleration take. */
const ramp = 0.2;
/**
 * Catch-up window [s since the jump] of an arm whose hand is tracked: the minimum progress along the arcs ramps from 0
 * to 1, so a moving goal is reached by the end. Longest measured transition: 0.7 s.
 */
const [hurrySeconds, longestSeconds] = [0.7, 0.9];
/** The smallest bend of an arm [sine of the angle] at which its plane is defined. */
const allButStraight = 0.1;
/** The number of steps in which a path is sampled; progress is found to a sixty-fourth of a step. */
const pathSteps = 8;
const fractionHalvings = 6;

/** The unit directions of an arm's bones and of the elbow's hinge, floor frame. */
export interface ArmDirections {
  readonly upperArm: MutableVec3;
  readonly forearm: MutableVec3;
  readonly hinge: MutableVec3;
}

export const makeArmDirections = (): ArmDirections => ({
  upperArm: vec3(0, 0, 0),
  forearm: vec3(0, 0, 0),
  hinge: vec3(0, 0, 0),
});

export function copyArmDirections(from: ArmDirections, target: ArmDirections): void {
  copyVec3(from.upperArm, target.upperArm);
  copyVec3(from.forearm, target.forearm);
  copyVec3(from.hinge, target.hinge);
}

/** The target of an arm in this frame, floor frame. */
export interface ArmGoal extends ArmDirections {
  readonly shoulder: Vec3;
  /** The position of the tracked hand, or at which it will rest; the arm may not reach it. */
  readonly hand: Vec3;
  /** The shortest duration of the transition [s], because a hand sinks slowly to rest; 0: the hand is tracked. */
  readonly minDuration: number;
  readonly bones: LimbBones;
  /** The unit direction through which an arm swings if its goal is on the opposite side. */
  readonly outside: Vec3;
}

/**
 * The state of an arm whose hand's goal has jumped. Both bones rotate on arcs from the drawn to the current goal
 * directions, by the same fraction in each frame; the speed of elbow and wrist is limited. Directions are in the floor
 * frame, so that a turn of the body does not fling the arm.
 */
export interface ArmTransition {
  /** The time since the jump [s]; NaN: there is no transition. */
  age: number;
  /** The current speed in addition to the motion of the goals [m/s]. */
  speed: number;
  /** The longest path of elbow or wrist since the jump [m], which limits their speed. */
  longestPath: number;
  /** The distances [m] that the goals of elbow and wrist move in this frame. */
  elbowMotion: number;
  wristMotion: number;
  /** The goals of elbow and wrist, and the drawn elbow and wrist, in the previous frame [m]. */
  readonly elbowGoal: MutableVec3;
  readonly wristGoal: MutableVec3;
  readonly elbow: MutableVec3;
  readonly wrist: MutableVec3;
  readonly upperArm: DirectionArc;
  readonly forearm: DirectionArc;
}

export const makeArmTransition = (): ArmTransition => ({
  age: Number.NaN,
  speed: Number.NaN,
  longestPath: Number.NaN,
  elbowMotion: Number.NaN,
  wristMotion: Number.NaN,
  elbowGoal: vec3(0, 0, 0),
  wristGoal: vec3(0, 0, 0),
  elbow: vec3(0, 0, 0),
  wrist: vec3(0, 0, 0),
  upperArm: makeDirectionArc(),
  forearm: makeDirectionArc(),
});

const turn = quat(0, 0, 0, 1);
const elbow = vec3(0, 0, 0);
const wrist = vec3(0, 0, 0);
const bone = vec3(0, 0, 0);
const unbent = vec3(0, 0, 0);
const elbowBefore = vec3(0, 0, 0);
const wristBefore = vec3(0, 0, 0);

/** Places `elbow` and `wrist` of an arm whose bones point in these directions. */
function placeJoints(upperArm: Vec3, forearm: Vec3, { shoulder, bones }: ArmGoal): void {
  addScaled(shoulder, upperArm, bones.upper, elbow);
  addScaled(elbow, forearm, bones.lower, wrist);
}

/** Places `elbow` and `wrist` at a fraction of the arcs. */
function placeAt({ upperArm, forearm }: ArmTransition, drawn: ArmDirections, wanted: ArmGoal, fraction: number): void {
  rotate(alongArc(upperArm, fraction, turn), drawn.upperArm, bone);
  rotate(alongArc(forearm, fraction, turn), drawn.forearm, unbent);
  placeJoints(bone, unbent, wanted);
}

/** Returns the longer path [m] of elbow and wrist on the arcs. */
function pathLength(transition: ArmTransition, drawn: ArmDirections, wanted: ArmGoal): number {
  let metres = 0;
  for (let step = 0; step <= pathSteps; step++) {
    placeAt(transition, drawn, wanted, step / pathSteps);
    if (step > 0) metres += Math.max(distance(elbow, elbowBefore), distance(wrist, wristBefore));
    copyVec3(elbow, elbowBefore);
    copyVec3(wrist, wristBefore);
  }
  return metres;
}

/** Returns how far [m] elbow or wrist moves beyond its goal, whichever is more, at a fraction of the arcs. */
function excessAt(transition: ArmTransition, drawn: ArmDirections, wanted: ArmGoal, fraction: number): number {
  placeAt(transition, drawn, wanted, fraction);
  return Math.max(
    distance(elbow, transition.elbow) - transition.elbowMotion,
    distance(wrist, transition.wrist) - transition.wristMotion,
  );
}

/**
 * Returns the fraction of the arcs up to which elbow and wrist move by no more than this [m] beyond their goals. If
 * shoulder motion alone exceeds the limit, returns the fraction with the least. Sampled in steps of 1/pathSteps.
 */
function progressWithin(transition: ArmTransition, drawn: ArmDirections, wanted: ArmGoal, metres: number): number {
  let nearest = 0;
  let least = excessAt(transition, drawn, wanted, 0);
  for (let step = 1; step <= pathSteps && (least > metres || nearest === step - 1); step++) {
    const off = excessAt(transition, drawn, wanted, step / pathSteps);
    if (off <= metres || off < least) {
      nearest = step;
      least = off;
    }
  }
  let fraction = nearest / pathSteps;
  if (least > metres || nearest === pathSteps) return fraction;
  // Bisection written out: a predicate for `bisect` would be a new closure in every frame.
  let tooFar = (nearest + 1) / pathSteps;
  for (let i = 0; i < fractionHalvings; i++) {
    const middle = (fraction + tooFar) / 2;
    if (excessAt(transition, drawn, wanted, middle) > metres) tooFar = middle;
    else fraction = middle;
  }
  return fraction;
}

export function startTransition(transition: ArmTransition, drawn: ArmDirections, wanted: ArmGoal): void {
  directionArc(drawn.upperArm, wanted.upperArm, wanted.outside, transition.upperArm);
  directionArc(drawn.forearm, wanted.forearm, wanted.outside, transition.forearm);
  transition.age = 0;
  transition.speed = 0;
  transition.longestPath = 0;
  storeDrawn(transition, drawn, wanted);
}

/** Stores the goals and the drawn positions of elbow and wrist in this frame. */
function storeDrawn(transition: ArmTransition, drawn: ArmDirections, wanted: ArmGoal): void {
  addScaled(wanted.shoulder, wanted.upperArm, wanted.bones.upper, transition.elbowGoal);
  copyVec3(wanted.hand, transition.wristGoal);
  placeJoints(drawn.upperArm, drawn.forearm, wanted);
  copyVec3(elbow, transition.elbow);
  copyVec3(wrist, transition.wrist);
}

/** Returns the path [m] of elbow and wrist in this frame beyond their goals': even acceleration and deceleration. */
function stepOf(transition: ArmTransition, toGo: number, wanted: ArmGoal, deltaSeconds: number): number {
  const seconds = Math.max(shortestSeconds, wanted.minDuration);
  transition.longestPath = Math.max(transition.longestPath, toGo);
  const needed = transition.longestPath / (hurrySeconds - shortestSeconds * ramp);
  const topSpeed = Math.min(Math.max(fastest, needed), transition.longestPath / (seconds * (1 - ramp)));
  const acceleration = topSpeed / (seconds * ramp);
  const slowing = Math.sqrt(2 * acceleration * toGo);
  transition.speed = Math.min(transition.speed + acceleration * deltaSeconds, topSpeed, slowing);
  return transition.speed * deltaSeconds;
}

/** Advances the transition by a frame: `drawn` contains the arm of the previous frame and receives that of this one. */
export function followTransition(
  transition: ArmTransition,
  wanted: ArmGoal,
  drawn: ArmDirections,
  deltaSeconds: number,
): void {
  const { upperArm, forearm } = transition;
  if (Number.isNaN(transition.age)) {
    copyArmDirections(wanted, drawn);
    return;
  }
  const passed = Math.max(deltaSeconds, 0);
  transition.age += passed;
  retargetArc(upperArm, drawn.upperArm, wanted.upperArm);
  retargetArc(forearm, drawn.forearm, wanted.forearm);
  transition.wristMotion = distance(wanted.hand, transition.wristGoal);
  addScaled(wanted.shoulder, wanted.upperArm, wanted.bones.upper, elbow);
  // An elbow whose estimate alone moves has no motion of its own.
  transition.elbowMotion = Math.min(distance(elbow, transition.elbowGoal), transition.wristMotion);
  const toGo = pathLength(transition, drawn, wanted);
  const step = stepOf(transition, toGo, wanted, passed);
  // Minimum fraction per frame: a third of the nominal progress, so shoulder motion cannot stall the transition; plus
  // the catch-up ramp.
  const least = Math.min(1, (transition.speed * passed) / Math.max(3 * toGo, 1e-9));
  const hurry =
    wanted.minDuration === 0 ? clamp((transition.age - hurrySeconds) / (longestSeconds - hurrySeconds), 0, 1) : 0;
  const fraction = Math.max(hurry, least, progressWithin(transition, drawn, wanted, step));
  if (fraction === 1 && transition.age >= shortestSeconds) transition.age = Number.NaN;
  advanceArcs(transition, wanted, drawn, fraction);
  storeDrawn(transition, drawn, wanted);
}

/** Rotates the drawn bones by a fraction of the arcs, and the hinge with them. */
function advanceArcs(
  { upperArm, forearm }: ArmTransition,
  wanted: ArmGoal,
  drawn: ArmDirections,
  fraction: number,
): void {
  if (fraction === 1) {
    copyArmDirections(wanted, drawn);
    return;
  }
  copyVec3(drawn.upperArm, bone);
  rotate(alongArc(upperArm, fraction, turn), drawn.upperArm, drawn.upperArm);
  rotate(alongArc(forearm, fraction, turn), drawn.forearm, drawn.forearm);
  advanceArc(upperArm, fraction);
  advanceArc(forearm, fraction);
  // The hinge is normal to the bones; for an almost straight arm it is interpolated from the drawn to the goal hinge.
  rotate(rotationBetween(bone, drawn.upperArm, turn), drawn.hinge, unbent);
  lerp(unbent, wanted.hinge, fraction, unbent);
  cross(drawn.upperArm, drawn.forearm, drawn.hinge);
  const isBent = dot(drawn.upperArm, drawn.forearm) < 0;
  const straightness = isBent ? 0 : Math.max(0, allButStraight - length(drawn.hinge));
  normalise(addScaled(drawn.hinge, unbent, straightness, drawn.hinge), wanted.hinge, drawn.hinge);
}
