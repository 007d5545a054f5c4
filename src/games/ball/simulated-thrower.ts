import {
  add,
  addScaled,
  clamp,
  copyVec3,
  createRandom,
  lerp,
  normalise,
  type Side,
  scale,
  subtract,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { gravity } from '../ballistics';
import { minimumJerk } from '../simulated-body';
import type { SimulatedInput } from '../simulated-input';
import { type BallBot, type BotView, nearestBall } from './ball-bot';
import {
  copyPosture,
  createPlayerPostures,
  makePosture,
  mixPostures,
  type PlayerBody,
  type PlayerPosture,
  type PlayerPostures,
} from './player-postures';
import { ballMatchTime } from './state-selectors';
import { rackPosition } from './stations';
import { ThrowPostures } from './throw-postures';
import { UnderarmThrow } from './underarm-throw';

interface Movement {
  readonly to: PlayerPosture;
  readonly seconds: number;
  /** Pressure on the throwing hand's button at the end. */
  readonly pressure: number;
  /** Height of the arc on the way [m]. */
  readonly arc?: number;
  /** The movement lasts until this returns true. */
  readonly until?: (sight: BotView) => boolean;
  /** The throw that moves the fist and releases the button. */
  readonly swung?: UnderarmThrow;
}

/** Flight time of a throw [s]. */
const flightSeconds = 0.86;
/** Interval between two throws [s], because a basket catches one ball at a time. */
const betweenThrows = 0.75;
/** Scatter of the throws' targets [m]. */
const scatter = 0.14;
/** The share of throws that go astray, as people's do, and how far beside the basket [m]: out of its holder's reach. */
const strayShare = 1 / 8;
const strayBeside = 1.1;

const rise = vec3(0, 0, 0);

/** Returns whether it is this thrower's turn, and nobody has just thrown. */
function mayThrow({ state, player }: BotView): boolean {
  if (state.phase !== 'running') return true;
  const now = ballMatchTime(state);
  for (const location of state.balls) {
    if (location.on === 'air' && !location.missed && now - location.launch.time < betweenThrows) return false;
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

  follow(time: number, sight: BotView): SimulatedInput {
    this.#postures.inFloor(sight.basket ?? sight.state.basket.position, this.#basket);
    this.#proceed(time, sight);
    const current = this.#plan[0];
    return current ? this.#move(current, time) : this.#postures.inputFor(this.#from, time, 0, 0);
  }

  /** Returns head, hands and buttons within a movement. */
  #move(current: Movement, time: number): SimulatedInput {
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
    return this.#postures.inputFor(now, time, left ? pressure : 0, left ? 0 : pressure);
  }

  /** Ends the movements that are over by `time` and plans the next. */
  #proceed(time: number, sight: BotView): void {
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
  #planNext(time: number, sight: BotView): boolean {
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
    const luck = this.#chance();
    if (Math.abs(luck) < strayShare) target.x += Math.sign(luck) * strayBeside;
    const reach = moves.reaching(side, at);
    const ready = moves.carrying(side, basket);
    const velocityFrom = (start: Vec3) =>
      add(scale(subtract(target, start), 1 / flightSeconds), vec3(0, 0.5 * gravity * flightSeconds, 0));
    // The ball's position in the hand depends slightly on the throw: one iteration suffices.
    const nearly = velocityFrom(moves.release(side));
    const velocity = velocityFrom(moves.leaving(side, normalise(nearly)));
    const swung = new UnderarmThrow(this.#postures, moves);
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
export const createSimulatedThrower = (body: PlayerBody, seed: number): BallBot => new Thrower(body, seed);
