import { wrapAngle } from '../../core/math/angle';
import { clamp, damp, smoothingFactor } from '../../core/math/damper';
import type { Side } from '../../core/math/side';
import { type MutableVec3, setVec3, type Vec3, vec3 } from '../../core/math/vec3';

/** A foot as drawn. All in the floor frame. */
export interface Foot {
  /** Ankle [m]; its height includes the ankle's own above the sole. */
  readonly position: Vec3;
  /** The direction of the toes: yaw [rad], 0 towards −Z. */
  readonly yaw: number;
  /** Downward tilt of the toes [rad] while the foot is in the air. */
  readonly pitch: number;
  readonly planted: boolean;
}

/**
 * The expected foot, on average (`Gait`): place on the floor [m], yaw of the toes [rad], probability of standing [0,
 * 1].
 */
export interface FootGoal {
  readonly x: number;
  readonly z: number;
  readonly yaw: number;
  readonly standing: number;
}

/** Measures of the legs [m]. */
export interface Stance {
  readonly ankleHeight: number;
  readonly legLength: number;
}

export interface Feet {
  readonly left: Foot;
  readonly right: Foot;
}

interface FootState {
  readonly position: MutableVec3;
  yaw: number;
  pitch: number;
  planted: boolean;
  /** The height of the sole [m]. */
  height: number;
  /** The smoothed probability of standing. */
  standing: number;
  /** The time since it was lifted or put down [s]. */
  seconds: number;
  /** Whether it was left behind, and takes one step in any case. */
  leftBehind: boolean;
  goalX: number;
  goalZ: number;
  velocityX: number;
  velocityZ: number;
}

export interface Stepping {
  /** Advances the feet by `deltaSeconds` with these goals; returns the same object in every frame. */
  update(goals: Readonly<Record<Side, FootGoal>>, stance: Stance, deltaSeconds: number): Feet;
  /** Moves the feet to their goals in the next frame. */
  reset(): void;
}

/** The parameters of a step. Half-lives and durations in seconds. */
export interface SteppingParameters {
  /** The probability of standing below which a foot is lifted, and above which it is put down. */
  readonly liftBelow: number;
  readonly plantAbove: number;
  /** The shortest time of a foot in the air, or on the floor. */
  readonly shortestSwing: number;
  readonly shortestStance: number;
  /** The longest time of a foot in the air: with arms held high the estimate is a jump that never ends. */
  readonly longestSwing: number;
  /** The distance of a goal [leg lengths] below which a foot takes no step. */
  readonly leastWay: number;
  /**
   * The distance of a goal [leg lengths], or its turn [rad], beyond which a foot is left behind, and the duration of
   * its step.
   */
  readonly farthest: number;
  readonly turnLimit: number;
  readonly ownStep: number;
  /** The time ahead at which a foot in the air aims for its goal. */
  readonly lead: number;
  readonly followHalfLife: number;
  readonly standingHalfLife: number;
  /** The largest lift of the sole [leg lengths]. */
  readonly liftShare: number;
}

/** The parameters found by coordinate descent on 26 people that the gait network was not trained on. */
export const standardStepping: SteppingParameters = {
  liftBelow: 0.52,
  plantAbove: 0.58,
  shortestSwing: 0.11,
  shortestStance: 0.04,
  longestSwing: 0.8,
  leastWay: 0.05,
  farthest: 0.42,
  turnLimit: 0.8,
  ownStep: 0.22,
  lead: 0.1,
  followHalfLife: 0.06,
  standingHalfLife: 0.01,
  liftShare: 0.09,
};

/** The time [s] in which a lifted foot reaches its full speed. */
const takeOff = 0.12;
/** The smallest lift of a foot in the air: one that moves along the floor skates. */
const leastLift = 0.4;
const velocityHalfLife = 0.05;
const liftHalfLife = 0.03;
/**
 * The distance of the ball of a foot ahead of the ankle, in heights of the ankle: the floor limits the tilt of the
 * toes.
 */
const ballAhead = 1.6;
const mostTilt = 0.35;

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

/**
 * Feet stand where they were put until they are expected to lift, or are left behind; in the air they follow their
 * goals.
 */
class TwoFeet implements Stepping {
  private readonly feet: Readonly<Record<Side, FootState>> = { left: makeFoot(), right: makeFoot() };
  private standing = false;

  constructor(private readonly parameters: SteppingParameters) {}

  update(goals: Readonly<Record<Side, FootGoal>>, stance: Stance, deltaSeconds: number): Feet {
    const { feet } = this;
    if (!this.standing) {
      plant(feet.left, goals.left, stance);
      plant(feet.right, goals.right, stance);
      this.standing = true;
    }
    this.advance(feet.left, goals.left, stance, deltaSeconds);
    this.advance(feet.right, goals.right, stance, deltaSeconds);
    return feet;
  }

  reset(): void {
    this.standing = false;
  }

  private advance(foot: FootState, goal: FootGoal, stance: Stance, deltaSeconds: number): void {
    if (deltaSeconds <= 0) return;
    followGoal(foot, goal, this.parameters, deltaSeconds);
    if (foot.planted) this.liftWhereDue(foot, goal, stance);
    else this.plantWhereDue(foot);
    const before = foot.height;
    foot.height = damp(before, foot.planted ? 0 : this.liftOf(foot, stance), liftHalfLife, deltaSeconds);
    if (!foot.planted) this.swing(foot, goal, deltaSeconds);
    foot.position.y = stance.ankleHeight + foot.height;
    // Toes hang while the foot rises and are drawn up before it lands.
    const tilt = clamp((foot.height - before) / deltaSeconds, -0.4, 0.8) * 0.6;
    const free = (0.5 * foot.height) / (ballAhead * stance.ankleHeight);
    foot.pitch = Math.min(damp(foot.pitch, clamp(tilt, -mostTilt, mostTilt), velocityHalfLife, deltaSeconds), free);
    if (foot.planted) foot.pitch = Math.max(foot.pitch, -free);
  }

  private liftWhereDue(foot: FootState, goal: FootGoal, { legLength }: Stance): void {
    const { liftBelow, shortestStance, leastWay, farthest, turnLimit } = this.parameters;
    const x = goal.x - foot.position.x;
    const z = goal.z - foot.position.z;
    const way = Math.sqrt(x * x + z * z) / legLength;
    const lifts = foot.standing < liftBelow && foot.seconds > shortestStance && way > leastWay;
    const far = way > farthest || Math.abs(wrapAngle(goal.yaw - foot.yaw)) > turnLimit;
    if (!lifts && !far) return;
    foot.planted = false;
    foot.leftBehind = !lifts;
    foot.seconds = 0;
  }

  private plantWhereDue(foot: FootState): void {
    const { plantAbove, shortestSwing, longestSwing, ownStep } = this.parameters;
    const stands = foot.standing > plantAbove && foot.seconds > shortestSwing;
    const lands = foot.leftBehind ? foot.seconds > ownStep : stands || foot.seconds > longestSwing;
    if (!lands) return;
    foot.planted = true;
    foot.seconds = 0;
  }

  private liftOf(foot: FootState, { legLength }: Stance): number {
    const { plantAbove, ownStep, liftShare } = this.parameters;
    const highest = liftShare * legLength;
    if (foot.leftBehind) return 0.6 * highest * Math.sin(Math.PI * Math.min(1, foot.seconds / ownStep));
    return highest * clamp((1.5 * (plantAbove - foot.standing)) / plantAbove, leastLift, 1);
  }

  private swing(foot: FootState, goal: FootGoal, deltaSeconds: number): void {
    const { lead, followHalfLife } = this.parameters;
    const share = smoothingFactor(followHalfLife, deltaSeconds) * Math.min(1, foot.seconds / takeOff);
    const { position } = foot;
    position.x += (goal.x + foot.velocityX * lead - position.x) * share;
    position.z += (goal.z + foot.velocityZ * lead - position.z) * share;
    foot.yaw += wrapAngle(goal.yaw - foot.yaw) * share;
  }
}

function followGoal(foot: FootState, goal: FootGoal, parameters: SteppingParameters, deltaSeconds: number): void {
  foot.seconds += deltaSeconds;
  foot.standing = damp(foot.standing, goal.standing, parameters.standingHalfLife, deltaSeconds);
  foot.velocityX = damp(foot.velocityX, (goal.x - foot.goalX) / deltaSeconds, velocityHalfLife, deltaSeconds);
  foot.velocityZ = damp(foot.velocityZ, (goal.z - foot.goalZ) / deltaSeconds, velocityHalfLife, deltaSeconds);
  foot.goalX = goal.x;
  foot.goalZ = goal.z;
}

/** Puts a foot down at its goal. */
function plant(foot: FootState, goal: FootGoal, { ankleHeight }: Stance): void {
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

export const createStepping = (parameters = standardStepping): Stepping => new TwoFeet(parameters);
