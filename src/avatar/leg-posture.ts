import { sideSign } from '../core/body/skeleton';
import { elbowCircle, elbowOnCircle, makeElbowCircle, poleAcross } from '../core/body/two-bone-ik';
import type { Pose } from '../core/math/pose';
import { fromAxes, fromAxisAngle, type MutableQuat, multiply, type Quat, quat, rotate } from '../core/math/quat';
import type { Side } from '../core/math/side';
import {
  add,
  addScaled,
  copyVec3,
  cross,
  forward,
  length,
  type MutableVec3,
  normalise,
  right,
  scale,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../core/math/vec3';
import { createStepping, type Foot, type SteppingParameters } from './stepping';

/** What legs need of a body that stands, facing −Z [m]. */
export interface LegProportions {
  /** The right hip joint from the hips' own, level with the floor. */
  readonly hipOffset: Vec3;
  readonly upper: number;
  readonly lower: number;
  readonly ankleHeight: number;
  /** Half the distance between the feet. */
  readonly halfWidth: number;
}

/** One leg, floor frame [m]; rotations from T-pose. */
export interface LegPose {
  readonly hip: Vec3;
  readonly knee: Vec3;
  readonly ankle: Vec3;
  readonly thigh: Quat;
  readonly shank: Quat;
  readonly foot: Quat;
}

interface MutableLegPose extends LegPose {
  readonly hip: MutableVec3;
  readonly knee: MutableVec3;
  readonly ankle: MutableVec3;
  readonly thigh: MutableQuat;
  readonly shank: MutableQuat;
  readonly foot: MutableQuat;
}

/** A leg is never quite straight [share of its length]: a knee that snaps straight is seen. */
const longestReach = 0.999;

const makeLeg = (): MutableLegPose => ({
  hip: vec3(0, 0, 0),
  knee: vec3(0, 0, 0),
  ankle: vec3(0, 0, 0),
  thigh: quat(0, 0, 0, 1),
  shank: quat(0, 0, 0, 1),
  foot: quat(0, 0, 0, 1),
});

// Scratch of one call; nothing of it is kept.
const ahead = vec3(0, 0, 0);
const overhead = vec3(0, 0, 0);
const way = vec3(0, 0, 0);
const level = quat(0, 0, 0, 1);
const levelForward = vec3(0, 0, 0);
const footTurn = quat(0, 0, 0, 1);
const toes = vec3(0, 0, 0);
const pole = vec3(0, 0, 0);
const bend = vec3(0, 0, 0);
const line = vec3(0, 0, 0);
const nod = quat(0, 0, 0, 1);
const axisX = vec3(0, 0, 0);
const axisY = vec3(0, 0, 0);
const axisZ = vec3(0, 0, 0);
const kneeCircle = makeElbowCircle();
const fallbacks: readonly [Vec3, Vec3] = [levelForward, up];

/** The rotation that takes a leg hanging down, toes to −Z, along `direction` with its knee towards `towards`. */
function aimDown(direction: Vec3, towards: Vec3, target: MutableQuat): Quat {
  normalise(scale(direction, -1, axisY), up, axisY);
  scale(towards, -1, axisZ);
  normalise(cross(axisY, axisZ, axisX), right, axisX);
  return fromAxes(axisX, axisY, cross(axisX, axisY, axisZ), target);
}

/** Two legs under a pelvis: no estimate, but what a standing or walking person's would do. */
export class LegPosture {
  /** The same objects in every frame. */
  readonly legs: Readonly<Record<Side, LegPose>>;
  private readonly own = { left: makeLeg(), right: makeLeg() };
  private readonly stepping;
  private readonly stance = { pelvis: vec3(0, 0, 0), yaw: 0, halfWidth: 0, ankleHeight: 0, legLength: 0 };

  constructor(
    private proportions: LegProportions,
    parameters?: SteppingParameters,
  ) {
    this.legs = this.own;
    this.stepping = createStepping(parameters);
  }

  /** Other legs, which stand up anew. */
  fit(proportions: LegProportions): void {
    this.proportions = proportions;
    this.stepping.reset();
  }

  /** Stands or steps under these hips, floor frame. */
  update(hips: Pose<'floor'>, deltaSeconds: number): void {
    const { stance, proportions } = this;
    const yaw = yawOfHips(hips.orientation);
    fromAxisAngle(up, yaw, level);
    rotate(level, forward, levelForward);
    // Between the hip joints; the spine's lowest point lies behind them.
    rotate(level, setVec3(stance.pelvis, 0, 0, proportions.hipOffset.z), stance.pelvis);
    add(hips.position, stance.pelvis, stance.pelvis);
    stance.yaw = yaw;
    stance.halfWidth = proportions.halfWidth;
    stance.ankleHeight = proportions.ankleHeight;
    stance.legLength = proportions.upper + proportions.lower;
    const feet = this.stepping.update(stance, deltaSeconds);
    this.place('left', hips.position, feet.left);
    this.place('right', hips.position, feet.right);
  }

  private place(side: Side, hips: Vec3, foot: Foot): void {
    const { hipOffset, upper, lower } = this.proportions;
    const leg = this.own[side];
    const { hip, knee, ankle } = leg;
    // Legs hang from a pelvis that tilts less than the lower back above it.
    setVec3(hip, sideSign(side) * hipOffset.x, hipOffset.y, hipOffset.z);
    add(hips, rotate(level, hip, hip), hip);
    const reach = (upper + lower) * longestReach;
    const far = length(subtract(foot.position, hip, line));
    // A pelvis higher than its legs are long takes the feet off the floor.
    if (far > reach) addScaled(hip, line, reach / far, ankle);
    else copyVec3(foot.position, ankle);
    rotate(fromAxisAngle(up, foot.yaw, footTurn), forward, toes);
    normalise(add(toes, levelForward, pole), levelForward, pole);
    const circle = elbowCircle(hip, ankle, this.proportions, levelForward, kneeCircle);
    elbowOnCircle(circle, poleAcross(circle.axis, pole, fallbacks, bend), knee);
    aimDown(subtract(knee, hip, line), pole, leg.thigh);
    aimDown(subtract(ankle, knee, line), pole, leg.shank);
    multiply(footTurn, fromAxisAngle(right, -foot.pitch, nod), leg.foot);
  }
}

/** Which way hips face [rad], 0 towards −Z; bent over, their forward points down and their up points ahead: together they know the way. */
function yawOfHips(orientation: Quat): number {
  rotate(orientation, forward, ahead);
  rotate(orientation, up, overhead);
  scale(ahead, Math.max(0, overhead.y), way);
  addScaled(way, overhead, Math.max(0, -ahead.y), way);
  return Math.atan2(-way.x, -way.z);
}
