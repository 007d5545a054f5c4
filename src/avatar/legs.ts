import { sideSign } from '../core/body/skeleton';
import { elbowCircle, elbowOnCircle, makeElbowCircle, poleAcross } from '../core/body/two-bone-ik';
import type { Pose } from '../core/math/pose';
import { fromAxes, fromAxisAngle, multiply, type Quat, quat, rotate } from '../core/math/quat';
import type { Side } from '../core/math/side';
import {
  add,
  addScaled,
  copyVec3,
  cross,
  forward,
  length,
  normalise,
  right,
  scale,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../core/math/vec3';
import type { AvatarJoint, Rig } from './rig';
import { createStepping, type Foot } from './stepping';

const bonesOf = {
  left: { thigh: 'leftUpperLeg', shank: 'leftLowerLeg', foot: 'leftFoot' },
  right: { thigh: 'rightUpperLeg', shank: 'rightLowerLeg', foot: 'rightFoot' },
} as const satisfies Record<Side, Record<string, AvatarJoint>>;

/** A leg is never quite straight [share of its length]: a knee that snaps straight is seen. */
const longestReach = 0.999;

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
const hip = vec3(0, 0, 0);
const knee = vec3(0, 0, 0);
const ankle = vec3(0, 0, 0);
const line = vec3(0, 0, 0);
const turn = quat(0, 0, 0, 1);
const nod = quat(0, 0, 0, 1);
const axisX = vec3(0, 0, 0);
const axisY = vec3(0, 0, 0);
const axisZ = vec3(0, 0, 0);
const kneeCircle = makeElbowCircle();
const fallbacks: readonly [Vec3, Vec3] = [levelForward, up];

/** The rotation that takes a leg hanging down, toes to −Z, along `direction` with its knee towards `towards`. */
function aimDown(direction: Vec3, towards: Vec3): Quat {
  normalise(scale(direction, -1, axisY), up, axisY);
  scale(towards, -1, axisZ);
  normalise(cross(axisY, axisZ, axisX), right, axisX);
  return fromAxes(axisX, axisY, cross(axisX, axisY, axisZ), turn);
}

/** The legs of an avatar: no estimate, but what a standing or walking person's would do under this pelvis. */
export class Legs {
  private readonly stepping = createStepping();
  /** The right hip joint from the hips' own, level with the floor, facing −Z [m]. */
  private readonly hipOffset = vec3(0.09, -0.06, 0);
  private bones = { upper: 0.42, lower: 0.42 };
  private ankleHeight = 0.08;
  private halfWidth = 0.1;
  private readonly stance = { pelvis: vec3(0, 0, 0), yaw: 0, halfWidth: 0, ankleHeight: 0, legLength: 0 };
  private readonly whole: boolean;

  constructor(private readonly rig: Rig) {
    this.whole = rig.bones.has('leftFoot') && rig.bones.has('rightFoot');
  }

  /** The rig's own shares of what is left below hips this high [m], on a rig scaled by `rigScale`; returns the lengths of its bones. */
  fit(hipsHeight: number, rigScale: number): { readonly upper: number; readonly lower: number } {
    const { rig } = this;
    const hipAtRest = rig.rest('leftUpperLeg');
    const kneeAtRest = rig.rest('leftLowerLeg');
    const ankleAtRest = rig.rest('leftFoot');
    if (hipAtRest && kneeAtRest && ankleAtRest) {
      const hips = rig.rest('hips') ?? up;
      const downScale = hipsHeight / hips.y;
      // The rig faces +Z, we face −Z.
      const aside = Math.abs(hipAtRest.x - hips.x) * rigScale;
      setVec3(this.hipOffset, aside, (hipAtRest.y - hips.y) * downScale, -(hipAtRest.z - hips.z) * rigScale);
      this.bones = {
        upper: hipAtRest.distanceTo(kneeAtRest) * downScale,
        // The ankle keeps the foot's own size; the rest of the difference goes to the shank.
        lower: kneeAtRest.distanceTo(ankleAtRest) * downScale + ankleAtRest.y * (downScale - rigScale),
      };
      this.ankleHeight = ankleAtRest.y * rigScale;
      this.halfWidth = Math.abs(ankleAtRest.x) * rigScale;
    }
    this.stepping.reset();
    return this.bones;
  }

  /** Stands or steps under these hips, floor frame. */
  apply(hips: Pose<'floor'>, deltaSeconds: number): void {
    if (!this.whole) return;
    const { stance, hipOffset } = this;
    const yaw = yawOfHips(hips.orientation);
    fromAxisAngle(up, yaw, level);
    rotate(level, forward, levelForward);
    // Between the hip joints; the spine's lowest point lies behind them.
    rotate(level, setVec3(stance.pelvis, 0, 0, hipOffset.z), stance.pelvis);
    add(hips.position, stance.pelvis, stance.pelvis);
    stance.yaw = yaw;
    stance.halfWidth = this.halfWidth;
    stance.ankleHeight = this.ankleHeight;
    stance.legLength = this.bones.upper + this.bones.lower;
    const feet = this.stepping.update(stance, deltaSeconds);
    this.place('left', hips, feet.left);
    this.place('right', hips, feet.right);
  }

  private place(side: Side, hips: Pose<'floor'>, foot: Foot): void {
    const { rig, bones, hipOffset } = this;
    const { thigh, shank, foot: footBone } = bonesOf[side];
    // Legs hang from a pelvis that tilts less than the lower back above it.
    setVec3(hip, sideSign(side) * hipOffset.x, hipOffset.y, hipOffset.z);
    add(hips.position, rotate(level, hip, hip), hip);
    const reach = (bones.upper + bones.lower) * longestReach;
    const far = length(subtract(foot.position, hip, line));
    // A pelvis higher than its legs are long takes the feet off the floor.
    if (far > reach) addScaled(hip, line, reach / far, ankle);
    else copyVec3(foot.position, ankle);
    rotate(fromAxisAngle(up, foot.yaw, footTurn), forward, toes);
    normalise(add(toes, levelForward, pole), levelForward, pole);
    const circle = elbowCircle(hip, ankle, bones, levelForward, kneeCircle);
    elbowOnCircle(circle, poleAcross(circle.axis, pole, fallbacks, bend), knee);
    rig.place(thigh, hip, aimDown(subtract(knee, hip, line), pole));
    rig.place(shank, knee, aimDown(subtract(ankle, knee, line), pole));
    rig.place(footBone, ankle, multiply(footTurn, fromAxisAngle(right, -foot.pitch, nod), turn));
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
