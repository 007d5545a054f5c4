import type { ExpectedFoot } from '../../core/estimation/gait/gait';
import { wrapAngle } from '../../core/math/angle';
import { clamp, damp, smoothingFactor } from '../../core/math/damper';
import type { Side } from '../../core/math/side';
import { distance, type MutableVec3, setVec3, type Vec3, vec3 } from '../../core/math/vec3';
import type { Mutable } from '../../core/records';

/** A drawn foot, floor frame. */
export interface Foot {
  /** Ankle [m]; its height includes the ankle's own above the sole. */
  readonly position: Vec3;
  /** The direction of the toes: yaw [rad], 0 towards −Z. */
  readonly yaw: number;
  /** Downward tilt of the toes [rad] while the foot is in the air. */
  readonly pitch: number;
  readonly planted: boolean;
}

export type Feet = Readonly<Record<Side, Foot>>;

/** Measures of the legs [m]. */
export interface Stance {
  readonly ankleHeight: number;
  readonly legLength: number;
}

interface FootState extends Mutable<Foot> {
  readonly position: MutableVec3;
  /** The height of the sole [m]. */
  height: number;
  /** The time since it was lifted or put down [s]. */
  seconds: number;
  /** Whether the foot was left behind and must take a step. */
  leftBehind: boolean;
  /** The time for which its goal has been at rest [s]. */
  rest: number;
  /** The distance of its hip beyond the length of the leg [m]. */
  stretch: number;
  goalX: number;
  goalZ: number;
  velocityX: number;
  velocityZ: number;
}

// The parameters of a step, chosen on 15 of 31 people and judged on the others, each with a gait network that was not
// trained on them. Half-lives and durations in seconds.
/** The probability of standing below which a foot is lifted and above which it is put down. */
const stands = 0.5;
/** The longest time of a foot in the air: with arms held high the estimate is a jump that never ends. */
const longestSwing = 0.8;
/** The distance of a goal [leg lengths] below which a foot takes no step. */
const minStepDistance = 0.05;
/**
 * The distance of a goal [leg lengths], its turn [rad], or the stretch of the leg [m] beyond which a foot is left
 * behind, and the duration of its step. A heel that rises takes up less stretch.
 */
const farthest = 0.42;
const turnLimit = 0.8;
const longestStretch = 0.02;
const ownStep = 0.22;
/** A goal rests that is slower than this [m/s] for the duration of a step; distance and turn then count double. */
const restSpeed = 0.15;
/** The time ahead at which a foot in the air aims for its goal. */
const lead = 0.1;
const followHalfLife = 0.06;
/** The smallest height of the sole in the air [leg lengths]: one that moves along the floor skates. */
const clearance = 0.04;
/** The time [s] in which a lifted foot reaches its full speed. */
const takeOff = 0.12;
const velocityHalfLife = 0.03;
const liftHalfLife = 0.03;
/**
 * The distance of the ball of a foot ahead of the ankle, in heights of the ankle: the floor limits the tilt of the
 * toes.
 */
const ballAhead = 1.6;
const maxTilt = 0.35;

const makeFoot = (): FootState => ({
  position: vec3(0, 0, 0),
  yaw: 0,
  pitch: 0,
  planted: true,
  height: 0,
  seconds: 0,
  leftBehind: false,
  rest: 0,
  stretch: 0,
  goalX: 0,
  goalZ: 0,
  velocityX: 0,
  velocityZ: 0,
});

/** Feet stand still until they are expected to lift or are left behind; in the air they follow their goals. */
export class Stepping {
  private readonly feet: Readonly<Record<Side, FootState>> = { left: makeFoot(), right: makeFoot() };
  private standing = false;

  /**
   * Advances the feet by `deltaSeconds` with these goals, under legs that hang from these hips; returns the same object
   * in every frame.
   */
  update(
    goals: Readonly<Record<Side, ExpectedFoot>>,
    legs: Readonly<Record<Side, { readonly hip: Vec3 }>>,
    stance: Stance,
    deltaSeconds: number,
  ): Feet {
    const { feet } = this;
    if (!this.standing) {
      plant(feet.left, goals.left, stance);
      plant(feet.right, goals.right, stance);
      this.standing = true;
    }
    feet.left.stretch = distance(legs.left.hip, feet.left.position) - stance.legLength;
    feet.right.stretch = distance(legs.right.hip, feet.right.position) - stance.legLength;
    advance(feet.left, goals.left, feet.right, stance, deltaSeconds);
    advance(feet.right, goals.right, feet.left, stance, deltaSeconds);
    return feet;
  }

  /** Moves the feet to their goals in the next frame. */
  reset(): void {
    this.standing = false;
  }
}

function advance(foot: FootState, goal: ExpectedFoot, other: Foot, stance: Stance, deltaSeconds: number): void {
  if (deltaSeconds <= 0) return;
  followGoal(foot, goal, deltaSeconds);
  if (foot.planted) liftWhereDue(foot, goal, other, stance);
  else plantWhereDue(foot, goal);
  const before = foot.height;
  const lift = foot.planted ? 0 : Math.max(goal.lift, clearance * stance.legLength);
  foot.height = damp(before, lift, liftHalfLife, deltaSeconds);
  if (!foot.planted) swing(foot, goal, deltaSeconds);
  foot.position.y = stance.ankleHeight + foot.height;
  // Toes point down while the foot rises and up before it lands.
  const tilt = clamp((foot.height - before) / deltaSeconds, -0.4, 0.8) * 0.6;
  const free = (0.5 * foot.height) / (ballAhead * stance.ankleHeight);
  foot.pitch = Math.min(damp(foot.pitch, clamp(tilt, -maxTilt, maxTilt), velocityHalfLife, deltaSeconds), free);
  if (foot.planted) foot.pitch = Math.max(foot.pitch, -free);
}

/** Lifts a foot that is expected in the air, or left behind. */
function liftWhereDue(foot: FootState, goal: ExpectedFoot, other: Foot, { legLength }: Stance): void {
  const x = goal.x - foot.position.x;
  const z = goal.z - foot.position.z;
  const way = Math.sqrt(x * x + z * z) / legLength;
  const turn = Math.abs(wrapAngle(goal.yaw - foot.yaw));
  const rests = foot.rest > ownStep;
  const lifts = !rests && goal.standing < stands && way > minStepDistance;
  const limit = rests ? 0.5 : 1;
  const isFar = way > limit * farthest || turn > limit * turnLimit;
  const isStretched = foot.stretch > longestStretch && way > minStepDistance;
  // One foot steps after the other, unless the person leaves both behind.
  const isLeft = (isFar && !rests) || (other.planted && (isFar || isStretched));
  if (!lifts && !isLeft) return;
  foot.planted = false;
  foot.leftBehind = !lifts;
  foot.seconds = 0;
}

/** Puts a foot down that is expected to stand, has made its own step or followed a goal that rests. */
function plantWhereDue(foot: FootState, goal: ExpectedFoot): void {
  const stepped = foot.seconds > ownStep && (foot.leftBehind || foot.rest > ownStep);
  const stood = goal.standing > stands && foot.seconds > ownStep / 2;
  const expected = !foot.leftBehind && (stood || foot.seconds > longestSwing);
  if (!stepped && !expected) return;
  foot.planted = true;
  foot.seconds = 0;
}

function swing(foot: FootState, goal: ExpectedFoot, deltaSeconds: number): void {
  const fraction = smoothingFactor(followHalfLife, deltaSeconds) * Math.min(1, foot.seconds / takeOff);
  const { position } = foot;
  position.x += (goal.x + foot.velocityX * lead - position.x) * fraction;
  position.z += (goal.z + foot.velocityZ * lead - position.z) * fraction;
  foot.yaw += wrapAngle(goal.yaw - foot.yaw) * fraction;
}

function followGoal(foot: FootState, goal: ExpectedFoot, deltaSeconds: number): void {
  foot.seconds += deltaSeconds;
  foot.velocityX = damp(foot.velocityX, (goal.x - foot.goalX) / deltaSeconds, velocityHalfLife, deltaSeconds);
  foot.velocityZ = damp(foot.velocityZ, (goal.z - foot.goalZ) / deltaSeconds, velocityHalfLife, deltaSeconds);
  const { velocityX, velocityZ } = foot;
  const rests = Math.sqrt(velocityX * velocityX + velocityZ * velocityZ) < restSpeed;
  foot.rest = rests ? foot.rest + deltaSeconds : 0;
  foot.goalX = goal.x;
  foot.goalZ = goal.z;
}

/** Puts a foot down at its goal. */
function plant(foot: FootState, goal: ExpectedFoot, { ankleHeight }: Stance): void {
  setVec3(foot.position, goal.x, ankleHeight, goal.z);
  foot.yaw = goal.yaw;
  foot.pitch = 0;
  foot.planted = true;
  foot.height = 0;
  foot.rest = 0;
  foot.seconds = 0;
  foot.leftBehind = false;
  foot.goalX = goal.x;
  foot.goalZ = goal.z;
  foot.velocityX = 0;
  foot.velocityZ = 0;
}
