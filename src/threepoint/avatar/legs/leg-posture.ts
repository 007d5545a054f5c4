import type { TrackedFeet } from '../../core/body/avatar-pose';
import { sideSign } from '../../core/body/skeleton';
import { type ElbowCircle, elbowCircle, elbowOnCircle, makeElbowCircle, poleAcross } from '../../core/body/two-bone-ik';
import type { Gait } from '../../core/estimation/gait/gait';
import { type GaitPoints, yawOfHips } from '../../core/estimation/gait/gait-features';
import { confidenceBeyond, followPin, handOverSeconds, makePin, type Pin } from '../../core/estimation/pin';
import { wrapAngle } from '../../core/math/angle';
import { smoothstep } from '../../core/math/damper';
import { makePose } from '../../core/math/pose';
import {
  copyQuat,
  fromAxes,
  fromAxisAngle,
  type MutableQuat,
  multiply,
  type Quat,
  quat,
  rotate,
  slerp,
} from '../../core/math/quat';
import { type Side, sides } from '../../core/math/side';
import {
  add,
  addScaled,
  copyVec3,
  cross,
  distance,
  dot,
  forward,
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
} from '../../core/math/vec3';
import { yawOf } from '../../core/tracking/heading';
import { type Foot, Stepping } from './stepping';

/** The proportions of the legs of a body that stands facing −Z [m]. */
export interface LegProportions {
  /** The right hip joint from the hips' own, level with the floor. */
  readonly hipOffset: Vec3;
  readonly upper: number;
  readonly lower: number;
  readonly ankleHeight: number;
  /** The height of its hips [fraction of the person's]; under 1 for legs that are very short. */
  readonly hipsFraction: number;
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

/** The largest distance of hip and ankle [fraction of the leg's length]: a knee that snaps straight is visible. */
const longestReach = 0.999;
/**
 * The furthest that a knee turns outward [rad], and the distances of hip and ankle [fractions of the leg's length]
 * between which it does so.
 */
const widestKnee = 0.7;
const [closedLeg, openLeg] = [0.2, 0.6];
/** The least height of a knee's joint over the floor [m]. */
const kneeHeight = 0.06;
/**
 * The least height of a hip's joint over a standing ankle [m]. The hips of five people who sit on the floor are 0.09 to
 * 0.15 over it: their pelvis rolls back and sinks to the height of its hip joints.
 */
const hipOverAnkle = 0.02;
/** The largest displacement of the hips in one frame [leg lengths]. */
const longestWay = 0.5;
/**
 * The fastest turn about the vertical of both head and hips [rad/s], and the largest between two frames that lie far
 * apart [rad].
 */
const fastestTurn = 14;
const furthestTurn = Math.PI / 2;
/** The shortest frame [s] that is assumed: jittering time stamps report shorter ones. */
const shortestFrame = 1 / 60;

const makeLeg = (): MutableLegPose => ({
  hip: vec3(0, 0, 0),
  knee: vec3(0, 0, 0),
  ankle: vec3(0, 0, 0),
  thigh: quat(0, 0, 0, 1),
  shank: quat(0, 0, 0, 1),
  foot: quat(0, 0, 0, 1),
});

// Scratch variables of one call.
const level = quat(0, 0, 0, 1);
const levelForward = vec3(0, 0, 0);
const footTurn = quat(0, 0, 0, 1);
const toes = vec3(0, 0, 0);
const trackedToes = vec3(0, 0, 0);
const estimated = makePose<'floor'>();
const pole = vec3(0, 0, 0);
const bend = vec3(0, 0, 0);
const highest = vec3(0, 0, 0);
const aside = vec3(0, 0, 0);
const line = vec3(0, 0, 0);
const nod = quat(0, 0, 0, 1);
const hinge = vec3(0, 0, 0);
const axisY = vec3(0, 0, 0);
const axisZ = vec3(0, 0, 0);
const kneeCircle = makeElbowCircle();
const fallbacks: readonly [Vec3, Vec3] = [levelForward, up];

/**
 * Returns the rotation of a bone of a leg from hanging down, toes to −Z, to pointing along `direction`. `hinge`: the
 * unit axis of the knee.
 */
function aimDown(direction: Vec3, hinge: Vec3, target: MutableQuat): Quat {
  normalise(scale(direction, -1, axisY), up, axisY);
  return fromAxes(hinge, axisY, cross(hinge, axisY, axisZ), target);
}

/** Turns the direction of a knee outward, next to the trunk, as hip and ankle come together. */
function spreadKnee({ axis }: ElbowCircle, bend: MutableVec3, side: Side, reach: number): void {
  const angle = widestKnee * (1 - smoothstep(closedLeg, openLeg, reach));
  cross(axis, bend, aside);
  addScaled(scale(bend, Math.cos(angle), bend), aside, sideSign(side) * Math.sin(angle), bend);
}

/**
 * Moves an ankle that is closer to its hip than `least` [m] ahead, the further the closer it is: between a hip and an
 * ankle right under it, centimetres decide whether the knee is on the floor or at the chest. `ahead`: unit, level.
 */
function unfold(hip: Vec3, ankle: MutableVec3, ahead: Vec3, least: number): void {
  subtract(ankle, hip, line);
  const missing = least * least - dot(line, line);
  if (missing <= 0) return;
  const along = dot(line, ahead);
  const way = Math.sqrt(along * along + missing) - along;
  addScaled(ankle, ahead, (way * missing) / (least * least), ankle);
}

/**
 * Turns the direction of a knee on its circle up, as little as keeps the knee on the floor: of a squatting or kneeling
 * person. A knee straight below its circle goes outward.
 */
function keepAboveFloor({ axis, centre, radius }: ElbowCircle, bend: MutableVec3, side: Side): void {
  if (centre.y + radius * bend.y >= kneeHeight) return;
  const steep = length(reject(up, axis, highest));
  if (steep < 1e-6) return;
  scale(highest, 1 / steep, highest);
  cross(axis, highest, aside);
  const outward = dot(bend, aside) || sideSign(side) * dot(aside, rotate(level, right, hinge));
  const cosine = Math.min(1, (kneeHeight - centre.y) / (radius * steep));
  const sine = Math.sign(outward) * Math.sqrt(1 - cosine * cosine);
  addScaled(scale(highest, cosine, bend), aside, sine, bend);
}

/**
 * Poses two legs under a pelvis: feet stand and step as a gait network expects, or are where trackers pin them; knees
 * follow.
 */
export class LegPosture {
  /** The legs of the newest frame, in the same objects. */
  readonly legs: Readonly<Record<Side, LegPose>>;
  private readonly own = { left: makeLeg(), right: makeLeg() };
  private readonly pins: Readonly<Record<Side, Pin>> = { left: makePin(), right: makePin() };
  /** False before the first frame, in which a tracked foot is where its tracker is. */
  private known = false;
  private readonly stepping = new Stepping();
  private readonly stance = { ankleHeight: 0, legLength: 0 };
  private readonly lastHips = vec3(0, 0, 0);
  private lastHipsYaw = 0;
  private lastHeadYaw = 0;
  private seconds = 0;

  /** `eyeHeight`: that of the person [m], the unit of length of the gait network. */
  constructor(
    private proportions: LegProportions,
    private eyeHeight: number,
    private readonly gait: Gait,
  ) {
    this.legs = this.own;
  }

  /** Sets the proportions of the legs and resets them. */
  fit(proportions: LegProportions, eyeHeight: number): void {
    this.proportions = proportions;
    this.eyeHeight = eyeHeight;
    this.standUp();
  }

  /** Advances by one frame under the hips of a body, floor frame. feet: the ankles that trackers pin. */
  update(points: GaitPoints, deltaSeconds: number, feet?: TrackedFeet): void {
    const { stance, proportions, gait } = this;
    const { hips } = points;
    const hipsYaw = yawOfHips(hips.orientation);
    stance.ankleHeight = proportions.ankleHeight;
    stance.legLength = proportions.upper + proportions.lower;
    if (this.wasCarried(points, hipsYaw, deltaSeconds)) this.standUp();
    this.seconds += deltaSeconds;
    gait.update(points, this.eyeHeight, this.seconds);
    fromAxisAngle(up, hipsYaw, level);
    rotate(level, forward, levelForward);
    this.placeHip('left', hips.position);
    this.placeHip('right', hips.position);
    const steps = this.stepping.update(gait.feet, this.legs, stance, deltaSeconds);
    const pinStep = this.known ? deltaSeconds / handOverSeconds : 1;
    this.known = true;
    for (const side of sides) {
      const weight = this.pinFoot(side, steps[side], feet?.[side] ?? null, pinStep);
      this.place(side, steps[side], weight);
    }
  }

  /**
   * Returns whether the body jumped since the frame before, because the device or the user moved or turned it: the
   * feet follow at once.
   */
  private wasCarried({ hips, head }: GaitPoints, hipsYaw: number, deltaSeconds: number): boolean {
    const { lastHips, lastHipsYaw, lastHeadYaw } = this;
    const headYaw = yawOf(head.orientation);
    const x = hips.position.x - lastHips.x;
    const z = hips.position.z - lastHips.z;
    const hipsTurn = Math.abs(wrapAngle(hipsYaw - lastHipsYaw));
    const headTurn = Math.abs(wrapAngle(headYaw - lastHeadYaw));
    copyVec3(hips.position, lastHips);
    this.lastHipsYaw = hipsYaw;
    this.lastHeadYaw = headYaw;
    const maxTurn = Math.min(fastestTurn * Math.max(deltaSeconds, shortestFrame), furthestTurn);
    // The heading of head or hips alone may jump where it is badly defined.
    return Math.sqrt(x * x + z * z) > longestWay * this.stance.legLength || Math.min(hipsTurn, headTurn) > maxTurn;
  }

  private standUp(): void {
    this.gait.reset();
    this.stepping.reset();
    this.pins.left.fraction = 0;
    this.pins.right.fraction = 0;
    this.known = false;
  }

  /** Writes a hip joint. Legs hang from a pelvis that tilts less than the lower back above it. */
  private placeHip(side: Side, hips: Vec3): void {
    const { hipOffset, hipsFraction, ankleHeight } = this.proportions;
    const { hip } = this.own[side];
    const lowest = ankleHeight + hipOverAnkle;
    setVec3(hip, sideSign(side) * hipOffset.x, hipOffset.y, hipOffset.z);
    rotate(level, hip, hip);
    setVec3(hip, hips.x + hip.x, Math.max(hips.y * hipsFraction + hip.y, lowest), hips.z + hip.z);
  }

  /** Writes the ankle and the foot before the leg's reach counts; returns the weight of the tracker. */
  private pinFoot(side: Side, step: Foot, tracked: TrackedFeet[Side], pinStep: number): number {
    const { upper, lower } = this.proportions;
    const { hip, ankle, foot } = this.own[side];
    const pin = this.pins[side];
    copyVec3(step.position, ankle);
    multiply(fromAxisAngle(up, step.yaw, footTurn), fromAxisAngle(right, -step.pitch, nod), foot);
    copyVec3(ankle, estimated.position);
    copyQuat(foot, estimated.orientation);
    const confidence = tracked ? confidenceBeyond(distance(tracked.position, hip) - upper - lower) : 0;
    const weight = followPin(pin, estimated, tracked, confidence, pinStep);
    if (weight === 0) return 0;
    lerp(ankle, pin.target.position, weight, ankle);
    slerp(foot, pin.target.orientation, weight, foot);
    return weight;
  }

  private place(side: Side, step: Foot, trackedWeight: number): void {
    const { upper, lower } = this.proportions;
    const leg = this.own[side];
    const { hip, knee, ankle, foot } = leg;
    const reach = (upper + lower) * longestReach;
    const far = length(subtract(ankle, hip, line));
    // A pelvis higher than its legs are long takes the feet off the floor.
    if (far > reach) addScaled(hip, line, reach / far, ankle);
    rotate(fromAxisAngle(up, step.yaw, footTurn), forward, toes);
    if (trackedWeight > 0) lerp(toes, rotate(foot, forward, trackedToes), trackedWeight, toes);
    normalise(add(toes, levelForward, pole), levelForward, pole);
    unfold(hip, ankle, pole, (upper + lower) * closedLeg * (1 - trackedWeight));
    const circle = elbowCircle(hip, ankle, this.proportions, levelForward, kneeCircle);
    // The knee's own hinge stays level: along a leg that lies ahead of its hip, the pole itself has no direction.
    cross(cross(pole, up, hinge), circle.axis, bend);
    spreadKnee(circle, poleAcross(circle.axis, bend, fallbacks, bend), side, circle.span / (upper + lower));
    keepAboveFloor(circle, bend, side);
    elbowOnCircle(circle, bend, knee);
    // Both bones lie in the plane across the hinge, which is defined even where a thigh points to its knee's pole.
    cross(circle.axis, bend, hinge);
    aimDown(subtract(knee, hip, line), hinge, leg.thigh);
    aimDown(subtract(ankle, knee, line), hinge, leg.shank);
  }
}
