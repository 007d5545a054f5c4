import { clamp, dampVec3, smoothstep } from '../core/math/damper';
import { fromAxisAngle, quat, rotate } from '../core/math/quat';
import type { Side } from '../core/math/side';
import {
  add,
  addScaled,
  copyVec3,
  length,
  lerp,
  type MutableVec3,
  scale,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
  zero,
} from '../core/math/vec3';

/** Legs are no estimate: feet stand where they were put until the pelvis has left them. All in the floor frame. */
export interface Foot {
  /** Ankle [m]; its height includes the ankle's own above the sole. */
  readonly position: Vec3;
  /** Where the toes point: yaw [rad], 0 towards −Z. */
  readonly yaw: number;
  /** Downward tilt of the toes [rad] while the foot is in the air. */
  readonly pitch: number;
  readonly planted: boolean;
}

export interface Stance {
  /** Pelvis on the floor plane and its yaw [rad]. */
  readonly pelvis: Vec3;
  readonly yaw: number;
  /** Half the distance [m] between the feet, height of an ankle above its sole, length of a leg. */
  readonly halfWidth: number;
  readonly ankleHeight: number;
  readonly legLength: number;
}

export interface Feet {
  readonly left: Foot;
  readonly right: Foot;
}

/** A foot on its way. */
interface Step {
  readonly from: MutableVec3;
  fromYaw: number;
  readonly to: MutableVec3;
  toYaw: number;
  progress: number;
  /** [s] */
  duration: number;
}

/** Where a foot belongs. */
interface Place {
  readonly position: MutableVec3;
  yaw: number;
}

interface FootState {
  readonly position: MutableVec3;
  yaw: number;
  pitch: number;
  planted: boolean;
  readonly step: Step;
  readonly place: Place;
  /** How much it wants to step; more than 1: it is left behind. */
  urgency: number;
}

export interface Stepping {
  /**
   * Feet after `deltaSeconds` more in this stance; the same object in every frame. A jump of the pelvis takes the feet along.
   */
  update(stance: Stance, deltaSeconds: number): Feet;
  reset(): void;
}

/** When feet step, how fast and where to. */
export interface SteppingParameters {
  /** A foot is left behind when its place is farther than this, in leg lengths, or turned by more [rad]. */
  readonly strideShare: number;
  readonly turnLimit: number;
  /** The place that counts is where the pelvis will be after so long [s]. */
  readonly lookAhead: number;
  /** Durations [s] of a step that is just due and of one three times overdue. */
  readonly slowStep: number;
  readonly fastStep: number;
  /** A foot lands as far beyond its place as the pelvis goes in this share of a step, at most this far, in leg lengths. */
  readonly overshoot: number;
  readonly longestLead: number;
  /** A landing place follows the pelvis until this share of the step. */
  readonly landingFixed: number;
  /** A foot is lifted before the other is down only in running: when it is so overdue, and the other so far on its way [share]. */
  readonly overlapUrgency: number;
  readonly overlapProgress: number;
  readonly velocityHalfLife: number;
  /** Distance between the feet, in that of the body at rest, and how far before the pelvis they stand, in leg lengths. */
  readonly widthShare: number;
  readonly aheadShare: number;
  /** Toes turn out by this much [rad]. */
  readonly toesOut: number;
}

export const standardStepping: SteppingParameters = {
  strideShare: 0.17,
  turnLimit: 0.6,
  lookAhead: 0.12,
  slowStep: 0.34,
  fastStep: 0.16,
  overshoot: 0.5,
  longestLead: 0.35,
  landingFixed: 0.6,
  overlapUrgency: 4,
  overlapProgress: 0.75,
  velocityHalfLife: 0.08,
  widthShare: 1,
  aheadShare: 0,
  toesOut: 0.12,
};

/** Farther than this, in leg lengths, no one steps: the person was moved. */
const jumpShare = 1.3;

const wrap = (angle: number): number => Math.atan2(Math.sin(angle), Math.cos(angle));

/** Distance along the floor [m]. */
function distanceAcross(a: Vec3, b: Vec3): number {
  const x = a.x - b.x;
  const z = a.z - b.z;
  return Math.sqrt(x * x + z * z);
}

/** A vector no longer than `longest`. */
function limit(v: MutableVec3, longest: number): MutableVec3 {
  const l = length(v);
  return l > longest ? scale(v, longest / l, v) : v;
}

const makeFoot = (): FootState => ({
  position: vec3(0, 0, 0),
  yaw: 0,
  pitch: 0,
  planted: true,
  step: { from: vec3(0, 0, 0), fromYaw: 0, to: vec3(0, 0, 0), toYaw: 0, progress: 0, duration: 0 },
  place: { position: vec3(0, 0, 0), yaw: 0 },
  urgency: 0,
});

// Scratch of one call.
const turn = quat(0, 0, 0, 1);
const ahead = vec3(0, 0, 0);
const ground = vec3(0, 0, 0);
const pelvisNow = vec3(0, 0, 0);
const speed = vec3(0, 0, 0);

class TwoFeet implements Stepping {
  private readonly feet: Readonly<Record<Side, FootState>> = { left: makeFoot(), right: makeFoot() };
  private standing = false;
  private readonly velocity = vec3(0, 0, 0);
  private readonly lastPelvis = vec3(0, 0, 0);
  private hasPelvis = false;

  constructor(private readonly parameters: SteppingParameters) {}

  update(stance: Stance, deltaSeconds: number): Feet {
    const { feet } = this;
    const { left, right } = feet;
    this.followPelvis(stance, deltaSeconds);
    this.findPlace('left', stance);
    this.findPlace('right', stance);
    const farthest = jumpShare * stance.legLength;
    const far =
      distanceAcross(left.position, left.place.position) > farthest ||
      distanceAcross(right.position, right.place.position) > farthest;
    if (!this.standing || far) this.standUp();
    this.measureUrgency(left, stance);
    this.measureUrgency(right, stance);
    // One foot at a time; the one that is farther off goes first. Running overlaps: the other may start near the end.
    const leftFirst = left.urgency >= right.urgency;
    this.lift(leftFirst ? left : right, leftFirst ? right : left);
    this.lift(leftFirst ? right : left, leftFirst ? left : right);
    this.advance(left, stance, deltaSeconds);
    this.advance(right, stance, deltaSeconds);
    return feet;
  }

  reset(): void {
    this.standing = false;
    this.hasPelvis = false;
    copyVec3(zero, this.velocity);
  }

  private followPelvis(stance: Stance, deltaSeconds: number): void {
    const { velocity, lastPelvis } = this;
    setVec3(pelvisNow, stance.pelvis.x, 0, stance.pelvis.z);
    if (this.hasPelvis && distanceAcross(pelvisNow, lastPelvis) > 0.5 * stance.legLength) this.standing = false;
    if (deltaSeconds > 0 && this.hasPelvis) {
      scale(subtract(pelvisNow, lastPelvis, speed), 1 / deltaSeconds, speed);
      dampVec3(velocity, speed, this.parameters.velocityHalfLife, deltaSeconds, velocity);
    }
    copyVec3(pelvisNow, lastPelvis);
    this.hasPelvis = true;
  }

  /** Beside the pelvis, toes a little out. */
  private findPlace(side: Side, { pelvis, yaw, halfWidth, ankleHeight, legLength }: Stance): void {
    const { widthShare, aheadShare, toesOut } = this.parameters;
    const { place } = this.feet[side];
    const sigma = side === 'left' ? -1 : 1;
    const { position } = place;
    rotate(
      fromAxisAngle(up, yaw, turn),
      setVec3(position, sigma * halfWidth * widthShare, 0, -aheadShare * legLength),
      position,
    );
    add(pelvis, position, position);
    position.y = ankleHeight;
    place.yaw = yaw - sigma * toesOut;
  }

  private standUp(): void {
    copyVec3(zero, this.velocity);
    this.standing = true;
    plant(this.feet.left);
    plant(this.feet.right);
  }

  private measureUrgency(foot: FootState, { legLength }: Stance): void {
    const { strideShare, turnLimit, lookAhead } = this.parameters;
    const { place, position } = foot;
    copyVec3(this.velocity, ahead);
    addScaled(place.position, limit(ahead, 1.2), lookAhead, ahead);
    const left = distanceAcross(position, ahead) / (strideShare * legLength);
    foot.urgency = Math.max(left, Math.abs(wrap(foot.yaw - place.yaw)) / turnLimit);
  }

  private lift(foot: FootState, other: FootState): void {
    const { overlapUrgency, overlapProgress, slowStep, fastStep } = this.parameters;
    const mayLift = other.planted || (other.step.progress > overlapProgress && foot.urgency > overlapUrgency);
    if (!foot.planted || foot.urgency <= 1 || !mayLift) return;
    const { step, place } = foot;
    foot.planted = false;
    copyVec3(foot.position, step.from);
    step.fromYaw = foot.yaw;
    copyVec3(place.position, step.to);
    step.toYaw = place.yaw;
    step.progress = 0;
    step.duration = slowStep + (fastStep - slowStep) * smoothstep(1, 3, foot.urgency);
  }

  private advance(foot: FootState, stance: Stance, deltaSeconds: number): void {
    const { landingFixed, overshoot, longestLead } = this.parameters;
    const { step, place, position } = foot;
    if (foot.planted) {
      position.y = stance.ankleHeight;
      foot.pitch = 0;
      return;
    }
    step.progress = Math.min(1, step.progress + deltaSeconds / step.duration);
    if (step.progress < landingFixed) {
      scale(this.velocity, step.duration * (1 - step.progress + overshoot), step.to);
      add(place.position, limit(step.to, longestLead * stance.legLength), step.to);
      step.toYaw = place.yaw;
    }
    const share = smoothstep(0, 1, step.progress);
    const way = distanceAcross(step.from, step.to);
    const lift =
      Math.sin(Math.PI * step.progress) * clamp(0.25 * way, 0.02, 0.11) * Math.min(1, stance.legLength / 0.8);
    lerp(step.from, step.to, share, ground);
    setVec3(position, ground.x, stance.ankleHeight + lift, ground.z);
    foot.yaw = step.fromYaw + wrap(step.toYaw - step.fromYaw) * share;
    foot.pitch = 0.35 * Math.sin(Math.PI * step.progress) * (step.progress < 0.5 ? 1 : -0.5);
    if (step.progress < 1) return;
    setVec3(position, step.to.x, stance.ankleHeight, step.to.z);
    foot.planted = true;
    foot.pitch = 0;
  }
}

/** Puts a foot down at its place. */
function plant(foot: FootState): void {
  copyVec3(foot.place.position, foot.position);
  foot.yaw = foot.place.yaw;
  foot.pitch = 0;
  foot.planted = true;
}

export const createStepping = (parameters = standardStepping): Stepping => new TwoFeet(parameters);
