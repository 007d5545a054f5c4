import type { ExpectedFoot } from '../../core/estimation/gait/gait';
import { wrapAngle } from '../../core/math/angle';
import { clamp, damp, smoothingFactor } from '../../core/math/damper';
import type { Side } from '../../core/math/side';
import { type MutableVec3, setVec3, type Vec3, vec3 } from '../../core/math/vec3';
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
  /** The smoothed probability of standing. */
  standing: number;
  /** The time since it was lifted or put down [s]. */
  seconds: number;
  /** Whether the foot was left behind and must take a step. */
  leftBehind: boolean;
  goalX: number;
  goalZ: number;
  velocityX: number;
  velocityZ: number;
}

// The parameters of a step, found by coordinate descent on 26 people that the gait network was not trained on.
// Half-lives and durations in seconds.
/** The probability of standing below which a foot is lifted, and above which it is put down. */
const liftBelow = 0.52;
const plantAbove = 0.58;
/** The shortest time of a foot in the air, or on the floor. */
const shortestSwing = 0.11;
const shortestStance = 0.04;
/** The longest time of a foot in the air: with arms held high the estimate is a jump that never ends. */
const longestSwing = 0.8;
/** The distance of a goal [leg lengths] below which a foot takes no step. */
const minStepDistance = 0.05;
/**
 * The distance of a goal [leg lengths], or its turn [rad], beyond which a foot is left behind, and the duration of its
 * step.
 */
const farthest = 0.42;
const turnLimit = 0.8;
const ownStep = 0.22;
/** The time ahead at which a foot in the air aims for its goal. */
const lead = 0.1;
const followHalfLife = 0.06;
const standingHalfLife = 0.01;
/** The largest height of the sole [leg lengths]. */
const liftFraction = 0.09;

/** The time [s] in which a lifted foot reaches its full speed. */
const takeOff = 0.12;
/** The smallest lift of a foot in the air: one that moves along the floor skates. */
const minLift = 0.4;
const velocityHalfLife = 0.05;
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
  standing: 1,
  seconds: 0,
  leftBehind: false,
  goalX: 0,
  goalZ: 0,
  velocityX: 0,
  velocityZ: 0,
});

/** Feet stand still until they are expected to lift or are left behind; in the air they follow their goals. */
export class Stepping {
  private readonly feet: Readonly<Record<Side, FootState>> = { left: makeFoot(), right: makeFoot() };
  private standing = false;

  /** Advances the feet by `deltaSeconds` with these goals; returns the same object in every frame. */
  update(goals: Readonly<Record<Side, ExpectedFoot>>, stance: Stance, deltaSeconds: number): Feet {
    const { feet } = this;
    if (!this.standing) {
      plant(feet.left, goals.left, stance);
      plant(feet.right, goals.right, stance);
      this.standing = true;
    }
    advance(feet.left, goals.left, stance, deltaSeconds);
    advance(feet.right, goals.right, stance, deltaSeconds);
    return feet;
  }

  /** Moves the feet to their goals in the next frame. */
  reset(): void {
    this.standing = false;
  }
}

function advance(foot: FootState, goal: ExpectedFoot, stance: Stance, deltaSeconds: number): void {
  if (deltaSeconds <= 0) return;
  followGoal(foot, goal, deltaSeconds);
  if (foot.planted) liftWhereDue(foot, goal, stance);
  else plantWhereDue(foot);
  const before = foot.height;
  foot.height = damp(before, foot.planted ? 0 : liftOf(foot, stance), liftHalfLife, deltaSeconds);
  if (!foot.planted) swing(foot, goal, deltaSeconds);
  foot.position.y = stance.ankleHeight + foot.height;
  // Toes point down while the foot rises and up before it lands.
  const tilt = clamp((foot.height - before) / deltaSeconds, -0.4, 0.8) * 0.6;
  const free = (0.5 * foot.height) / (ballAhead * stance.ankleHeight);
  foot.pitch = Math.min(damp(foot.pitch, clamp(tilt, -maxTilt, maxTilt), velocityHalfLife, deltaSeconds), free);
  if (foot.planted) foot.pitch = Math.max(foot.pitch, -free);
}

function liftWhereDue(foot: FootState, goal: ExpectedFoot, { legLength }: Stance): void {
  const x = goal.x - foot.position.x;
  const z = goal.z - foot.position.z;
  const way = Math.sqrt(x * x + z * z) / legLength;
  const lifts = foot.standing < liftBelow && foot.seconds > shortestStance && way > minStepDistance;
  const far = way > farthest || Math.abs(wrapAngle(goal.yaw - foot.yaw)) > turnLimit;
  if (!lifts && !far) return;
  foot.planted = false;
  foot.leftBehind = !lifts;
  foot.seconds = 0;
}

function plantWhereDue(foot: FootState): void {
  const stands = foot.standing > plantAbove && foot.seconds > shortestSwing;
  const lands = foot.leftBehind ? foot.seconds > ownStep : stands || foot.seconds > longestSwing;
  if (!lands) return;
  foot.planted = true;
  foot.seconds = 0;
}

function liftOf(foot: FootState, { legLength }: Stance): number {
  const highest = liftFraction * legLength;
  if (foot.leftBehind) return 0.6 * highest * Math.sin(Math.PI * Math.min(1, foot.seconds / ownStep));
  return highest * clamp((1.5 * (plantAbove - foot.standing)) / plantAbove, minLift, 1);
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
  foot.standing = damp(foot.standing, goal.standing, standingHalfLife, deltaSeconds);
  foot.velocityX = damp(foot.velocityX, (goal.x - foot.goalX) / deltaSeconds, velocityHalfLife, deltaSeconds);
  foot.velocityZ = damp(foot.velocityZ, (goal.z - foot.goalZ) / deltaSeconds, velocityHalfLife, deltaSeconds);
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
  foot.standing = goal.standing;
  foot.seconds = 0;
  foot.leftBehind = false;
  foot.goalX = goal.x;
  foot.goalZ = goal.z;
  foot.velocityX = 0;
  foot.velocityZ = 0;
}
