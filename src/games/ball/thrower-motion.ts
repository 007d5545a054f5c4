import { clamp } from 'threepoint/core/math/damper';
import { createRandom } from 'threepoint/core/math/random';
import type { Side } from 'threepoint/core/math/side';
import {
  add,
  addScaled,
  copyVec3,
  distance,
  lerp,
  normalise,
  scale,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
} from 'threepoint/core/math/vec3';
import { gravity } from '../ballistics';
import { minimumJerk, type PlayerInput } from '../simulated-body';
import type { BallState } from './ball-state';
import {
  copyPosture,
  createPlayerPostures,
  makePosture,
  mixPostures,
  type PlayerBody,
  type PlayerPosture,
  type PlayerPostures,
} from './player-postures';
import { ballMatchTime } from './state-readings';
import { rackPosition, stations } from './stations';
import { type SwungThrow, ThrowPostures } from './throw-postures';

/** A bot's view of the match: the state, and its own player index. */
export interface BotSight {
  readonly state: BallState;
  readonly player: number;
  /** The centre of the basket's opening as drawn, arena frame. Default: that of the state. */
  readonly basket?: Vec3;
}

/** A built-in player, which produces hands and buttons for a whole match. */
export interface BallBot {
  /** Returns head, hands (own floor frame) and buttons at `time` [s, not decreasing]. */
  follow(time: number, sight: BotSight): PlayerInput;
}

interface Movement {
  readonly to: PlayerPosture;
  readonly seconds: number;
  /** Pressure on the throwing hand's button at the end. */
  readonly pressure: number;
  /** Height of the arc on the way [m]. */
  readonly arc?: number;
  /** The movement lasts until this returns true. */
  readonly until?: (sight: BotSight) => boolean;
  /** The throw that moves the fist and releases the button. */
  readonly swung?: SwungThrow;
}

/** Flight time of a throw [s]. */
const flightSeconds = 0.86;
/** Interval between two throws [s], because a basket catches one ball at a time. */
const betweenThrows = 0.75;
/** Scatter of the throws' targets [m]. */
const scatter = 0.14;

// Scratch of one call.
const rack = vec3(0, 0, 0);
const mark = vec3(0, 0, 0);
const rise = vec3(0, 0, 0);

/** Returns the nearest ball in a rack; null: none is within reach, or no round runs. */
export function nearestBall({ state, player }: BotSight): number | null {
  if (state.phase !== 'running') return null;
  const station = stations[state.players[player]?.station ?? 0];
  if (!station) return null;
  setVec3(mark, station.position.x, 1, station.position.z);
  let nearest: number | null = null;
  let least = 1;
  for (let ball = 0; ball < state.balls.length; ball++) {
    if (state.balls[ball]?.on !== 'rack') continue;
    const far = distance(rackPosition(ball, state.options.balls, rack), mark);
    if (far >= least) continue;
    nearest = ball;
    least = far;
  }
  return nearest;
}

/** Returns whether it is this thrower's turn, and nobody has just thrown. */
function mayThrow({ state, player }: BotSight): boolean {
  if (state.phase !== 'running') return true;
  const now = ballMatchTime(state);
  for (const place of state.balls) {
    if (place.on === 'air' && !place.missed && now - place.launch.time < betweenThrows) return false;
  }
  const station = state.players[player]?.station ?? 0;
  return Math.floor(now / betweenThrows) % 2 === station % 2;
}

class Thrower implements BallBot {
  readonly #postures: PlayerPostures;
  readonly #moves: ThrowPostures;
  readonly #random: () => number;
  readonly #from = makePosture();
  #fromPressure = 0;
  #began: number | null = null;
  #plan: Movement[] = [];
  #idle = true;
  #throwing: Side = 'right';
  readonly #now = makePosture();
  /** The basket's opening, own floor frame. */
  readonly #basket = vec3(0, 0, 0);

  constructor(body: PlayerBody, seed: number) {
    this.#postures = createPlayerPostures(body);
    this.#moves = new ThrowPostures(this.#postures);
    this.#random = createRandom(seed);
  }

  follow(time: number, sight: BotSight): PlayerInput {
    this.#postures.inFloor(sight.basket ?? sight.state.basket.position, this.#basket);
    this.#proceed(time, sight);
    const current = this.#plan[0];
    return current ? this.#move(current, time) : this.#postures.seen(this.#from, time, 0, 0);
  }

  /** Returns head, hands and buttons within a movement. */
  #move(current: Movement, time: number): PlayerInput {
    const { swung } = current;
    const elapsed = Math.min(time - (this.#began ?? 0), current.seconds);
    const share = minimumJerk(clamp(elapsed / current.seconds, 0, 1));
    const now = mixPostures(this.#from, current.to, share, this.#now);
    const { fist } = now[this.#throwing];
    if (swung) swung.swing(elapsed, fist);
    else lerp(fist, addScaled(fist, up, current.arc ?? 0, rise), Math.sin(Math.PI * share) ** 2, fist);
    const held = this.#fromPressure + (current.pressure - this.#fromPressure) * share;
    const pressure = swung ? (elapsed < swung.releaseAt ? 1 : 0) : held;
    const left = this.#throwing === 'left';
    return this.#postures.seen(now, time, left ? pressure : 0, left ? 0 : pressure);
  }

  /** Ends the movements that are over by `time` and plans the next. */
  #proceed(time: number, sight: BotSight): void {
    if (this.#began === null) {
      this.#began = 0;
      this.#moves.resting(this.#basket, this.#from);
    }
    for (;;) {
      const current = this.#plan[0];
      if (current) {
        if (time - this.#began < current.seconds) return;
        if (current.until && !current.until(sight)) return;
        copyPosture(current.to, this.#from);
        this.#fromPressure = current.pressure;
        this.#began = current.until ? time : this.#began + current.seconds;
        this.#plan.shift();
      } else if (!this.#planNext(time, sight)) return;
    }
  }

  /** Plans the next throw, or the movement to rest; returns false if the thrower rests already. */
  #planNext(time: number, sight: BotSight): boolean {
    const ball = nearestBall(sight);
    if (ball === null && this.#idle) return false;
    if (this.#idle) this.#began = time;
    this.#idle = ball === null;
    this.#plan =
      ball === null
        ? [{ to: this.#moves.resting(this.#basket), seconds: 0.9, pressure: 0, arc: 0 }]
        : this.#throwOf(this.#postures.inFloor(rackPosition(ball, sight.state.options.balls)));
    return true;
  }

  /** Returns a random number in [−1, 1]. */
  #chance(): number {
    return 2 * this.#random() - 1;
  }

  /**
   * Returns the movements of a throw: take the ball, bring it before the chest, wait for the turn, swing back, throw,
   * follow through.
   */
  #throwOf(at: Vec3): Movement[] {
    const moves = this.#moves;
    const basket = copyVec3(this.#basket);
    const side = at.x < 0 ? 'left' : 'right';
    this.#throwing = side;
    const target = add(basket, vec3(scatter * this.#chance(), 0, scatter * this.#chance()));
    const reach = moves.reaching(side, at);
    const ready = moves.carrying(side, basket);
    const velocityFrom = (start: Vec3) =>
      add(scale(subtract(target, start), 1 / flightSeconds), vec3(0, 0.5 * gravity * flightSeconds, 0));
    // The ball's position in the hand depends slightly on the throw: one iteration suffices.
    const nearly = velocityFrom(moves.release(side));
    const velocity = velocityFrom(moves.leaving(side, normalise(nearly)));
    const swung = moves.makeThrow();
    swung.aim(side, velocity, basket);
    const { wound, thrown, seconds } = swung;
    return [
      { to: reach, seconds: 0.75, pressure: 0, arc: 0.06 },
      { to: reach, seconds: 0.16, pressure: 1 },
      { to: ready, seconds: 0.6, pressure: 1, arc: 0.08 },
      { to: ready, seconds: 0.05, pressure: 1, until: mayThrow },
      { to: wound, seconds: 0.5, pressure: 1 },
      { to: thrown, seconds, pressure: 0, swung },
      { to: thrown, seconds: 0.2, pressure: 0 },
    ];
  }
}

/**
 * Creates a thrower that throws the balls of the racks underarm at the basket, and then rests. `seed` is that of the
 * scatter.
 */
export const createThrower = (body: PlayerBody, seed: number): BallBot => new Thrower(body, seed);
