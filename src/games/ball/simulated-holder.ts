import {
  add,
  addScaled,
  clamp,
  copyVec3,
  dampVec3,
  distance,
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
} from 'threepoint/math';
import { fallTime, velocityAt } from '../ballistics';
import type { SimulatedInput } from '../simulated-input';
import type { BallBot, BotView } from './ball-bot';
import type { BallState, TimedLaunch } from './ball-state';
import { gripRadius } from './basket';
import { ballInAir } from './flight';
import {
  createPlayerPostures,
  type MutableGrasp,
  makePosture,
  type PlayerBody,
  type PlayerPostures,
} from './player-postures';
import { ballMatchTime } from './state-selectors';

/** Half-life of each of two filters in series for the basket's motion [s], which make it start softly. */
const moveHalfLife = 0.055;
/** Half-life of the gaze [s]. */
const lookHalfLife = 0.06;
/** Lean of the basket towards a ball [share from upright to the ball's direction]. */
const lean = 0.5;
/** A ball further from the home position than this [m] is ignored. */
const widest = 0.85;

/** Writes the wanted position of the opening into `target`, own floor frame. `home`: the position at which it waits. */
type HolderGoal = (home: Vec3, target: MutableVec3) => Vec3;

/** Normal of a waiting basket. */
const waiting = normalise(vec3(0, 1, -0.25));
const upright = scale(up, 1 - lean);
const aheadOfEyes = vec3(0, -0.3, -2);

// Scratch of one call.
const point = vec3(0, 0, 0);
const wanted = vec3(0, 0, 0);
const across = vec3(0, 0, 0);

class Holder implements BallBot {
  readonly #postures: PlayerPostures;
  readonly #goalOf: HolderGoal | undefined;
  /** The position at which the opening waits, and the distance that the arms alone cover. */
  readonly #home: Vec3;
  readonly #level: Vec3;
  readonly #comfort: number;
  readonly #opening: MutableVec3;
  readonly #soft: MutableVec3;
  readonly #normal = copyVec3(waiting);
  readonly #softNormal = copyVec3(waiting);
  readonly #look: MutableVec3;
  readonly #posture = makePosture();
  readonly #goal = vec3(0, 0, 0);
  /** Position and direction of the next ball at the basket's height, floor frame. */
  readonly #at = vec3(0, 0, 0);
  readonly #into = vec3(0, 0, 0);
  #lastTime: number | null = null;

  constructor(body: PlayerBody, goalOf?: HolderGoal) {
    this.#postures = createPlayerPostures(body);
    this.#goalOf = goalOf;
    const { arm, eyes } = this.#postures;
    this.#home = add(eyes, vec3(0, -0.62 * arm - 0.06, -0.82 * arm));
    this.#level = vec3(this.#home.x, 0, this.#home.z);
    this.#comfort = 0.3 * arm;
    this.#opening = copyVec3(this.#home);
    this.#soft = copyVec3(this.#home);
    this.#look = add(eyes, aheadOfEyes);
  }

  follow(time: number, { state }: BotView): SimulatedInput {
    const elapsed = this.#lastTime === null ? 0 : clamp(time - this.#lastTime, 0, 0.1);
    this.#lastTime = time;
    const comes = this.#findNextBall(state);
    this.#carry(comes, elapsed);
    this.#stand();
    this.#watch(comes, state, elapsed);
    const { left, right: rightHand } = this.#posture;
    normalise(reject(right, this.#normal, across), undefined, across);
    this.#grip(left, -1);
    this.#grip(rightHand, 1);
    return this.#postures.inputFor(this.#posture, time, 1, 1);
  }

  /** Finds the next ball that comes down within reach; returns false if there is none. */
  #findNextBall(state: BallState): boolean {
    const now = ballMatchTime(state);
    let next: TimedLaunch | null = null;
    let soonest = Number.POSITIVE_INFINITY;
    for (const location of state.balls) {
      if (location.on !== 'air' || location.missed) continue;
      const { launch } = location;
      const when = launch.time + fallTime(launch, this.#home.y);
      if (when < now - 0.05 || when >= soonest) continue;
      this.#postures.inFloor(ballInAir(launch, when, point), point);
      if (distance(setVec3(point, point.x, 0, point.z), this.#level) > widest) continue;
      next = launch;
      soonest = when;
    }
    if (!next) return false;
    ballInAir(next, soonest, this.#at);
    add(this.#at, scale(velocityAt(next, soonest - next.time, point), 0.01, point), point);
    this.#postures.inFloor(point, point);
    this.#postures.inFloor(this.#at, this.#at);
    normalise(subtract(point, this.#at, this.#into), undefined, this.#into);
    return true;
  }

  /** Moves the basket to its goal or to where the ball comes down, and turns it towards the ball. */
  #carry(comes: boolean, elapsed: number): void {
    const goal = this.#goalOf?.(this.#home, this.#goal) ?? (comes ? this.#at : this.#home);
    if (comes) {
      add(upright, scale(this.#into, -lean, wanted), wanted);
      normalise(wanted, undefined, wanted);
    } else copyVec3(waiting, wanted);
    dampVec3(this.#soft, goal, moveHalfLife, elapsed, this.#soft);
    dampVec3(this.#opening, this.#soft, moveHalfLife, elapsed, this.#opening);
    dampVec3(this.#softNormal, wanted, moveHalfLife, elapsed, this.#softNormal);
    dampVec3(this.#normal, this.#softNormal, moveHalfLife, elapsed, this.#normal);
    normalise(this.#normal, undefined, this.#normal);
  }

  /** Moves the body as far as the arms do not reach. */
  #stand(): void {
    const { eyes } = this.#postures;
    const off = subtract(this.#opening, this.#home, point);
    const far = Math.hypot(off.x, off.z);
    const share = far > this.#comfort ? (far - this.#comfort) / far : 0;
    add(eyes, setVec3(off, off.x * share, clamp(off.y, -0.25, 0) * 0.6, off.z * share), this.#posture.eyes);
  }

  /** Turns the gaze to the flying ball. */
  #watch(comes: boolean, state: BallState, elapsed: number): void {
    const { eyes, gaze } = this.#posture;
    if (comes) this.#findFlying(state, point);
    else add(eyes, aheadOfEyes, point);
    dampVec3(this.#look, point, lookHalfLife, elapsed, this.#look);
    this.#postures.gazeAt(eyes, this.#look, gaze);
  }

  /** Writes the position of the first flying ball, floor frame; without one that of the opening. */
  #findFlying(state: BallState, target: MutableVec3): void {
    for (const location of state.balls) {
      if (location.on !== 'air' || location.missed) continue;
      this.#postures.inFloor(ballInAir(location.launch, ballMatchTime(state), target), target);
      return;
    }
    copyVec3(this.#opening, target);
  }

  /** Places a hand at the rim, on the left (−1) or right (1) of the opening. */
  #grip({ fist, knuckles, thumb }: MutableGrasp, sign: -1 | 1): void {
    addScaled(this.#opening, across, sign * gripRadius, fist);
    // Hands lie along the rim: knuckles ahead, thumbs out of the opening.
    reject(setVec3(knuckles, -0.1 * sign, -0.2, -1), this.#normal, knuckles);
    normalise(knuckles, undefined, knuckles);
    copyVec3(this.#normal, thumb);
  }
}

/**
 * Creates a holder that carries the basket to where the next ball comes down, with steps aside if needed. `goalOf`: the
 * position of the opening instead.
 */
export const createSimulatedHolder = (body: PlayerBody, goalOf?: HolderGoal): BallBot => new Holder(body, goalOf);
