import { clamp, smoothingFactor } from 'threepoint/core/math/damper';
import { type Transform, transformPoint } from 'threepoint/core/math/pose';
import { rotate } from 'threepoint/core/math/quat';
import type { Ray } from 'threepoint/core/math/ray';
import type { Side } from 'threepoint/core/math/side';
import {
  addScaled,
  distance,
  forward,
  type MutableVec3,
  normalise,
  scale,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/core/math/vec3';
import type { Launch } from '../ballistics';
import { minimumJerk } from '../posture';
import { createHolder } from './holder-motion';
import {
  copyPosture,
  createPlayerPostures,
  makePosture,
  mixPostures,
  type Performed,
  type PlayerBody,
  type PlayerPosture,
  type PlayerPostures,
} from './player-postures';
import { ballInHand } from './state-readings';
import { rackPosition } from './stations';
import { type SwungThrow, ThrowPostures } from './throw-postures';
import { type BallBot, type BotSight, nearestBall } from './thrower-motion';

/** What a person at a desk wants of a player: a mouse in the place of two hands. Own floor frame. */
export interface BallSteering {
  /** Unit direction. */
  readonly ray: Ray;
  /** A thrower swings back for as long as this is true, the longer the further the ball goes, and then throws. */
  readonly pressed: boolean;
  /** true: the arm comes down again, the ball in hand. */
  readonly cancelled: boolean;
}

/** A player who does as told. */
export interface SteeredPlayer extends BallBot {
  /** How the ball would leave the hand now, arena frame, the same object in every frame; null: no throw is being aimed. */
  readonly aim: Launch | null;
}

/** A hold this long [s] is the hardest throw; from the first to the second speed [m/s]. */
const fullSeconds = 1.3;
const softest = 4;
const hardest = 8.8;
/** No throw is meant steeper or flatter than these [rad above the horizon], and most are meant like this one. */
const flattest = 0.45;
const steepest = 1.2;
const usual = 0.85;
/** How much further up a throw goes than the pointer. */
const lift = 1.5;
/** Half-lives of the way to a posture [s]. */
const moveHalfLife = 0.07;
const windHalfLife = 0.045;
/** A fist this near to a ball [m] takes it, and waits this long [s] for it to be its own. */
const atBall = 0.07;
const takePatience = 0.6;
/** From where the arm is to where it swings from, and after the throw [s]. */
const leadSeconds = 0.1;
const followSeconds = 0.25;
/** A basket is carried this far to each side of where it waits [m]. */
const basketReach = 0.65;

/** Where a ray comes to the upright plane this far ahead [m]; beside or behind: as far aside as it can be meant. */
function ahead({ origin, direction }: Ray, z: number, target: MutableVec3): MutableVec3 {
  const along = direction.z < -0.05 ? (z - origin.z) / direction.z : 20;
  addScaled(origin, direction, clamp(along, 0, 20), target);
  return setVec3(target, clamp(target.x, -4, 4), clamp(target.y, 0, 3.5), z);
}

type Phase = 'idle' | 'reaching' | 'taking' | 'ready' | 'drawing' | 'swinging' | 'following';

/** One frame of a player at the mouse. */
interface Moment {
  time: number;
  sight: BotSight;
  wish: BallSteering;
  /** Whether the ball is in the throwing hand. */
  holds: boolean;
}

// Memory of one call: a frame makes no garbage.
const level = vec3(0, 0, 0);
const rack = vec3(0, 0, 0);

class SteeredThrower implements SteeredPlayer {
  readonly #steering: () => BallSteering;
  readonly #arenaFromFloor: Transform<'arena', 'floor'>;
  readonly #postures: PlayerPostures;
  readonly #moves: ThrowPostures;
  #phase: Phase = 'idle';
  #began = 0;
  #last: number | null = null;
  readonly #posture = makePosture();
  /** Whether `#posture` has been taken. */
  #posed = false;
  /** The posture that a swing begins with. */
  readonly #from = makePosture();
  readonly #goal = makePosture();
  #side: Side = 'right';
  #ball = 0;
  readonly #swung: SwungThrow;
  readonly #aim = { position: vec3(0, 0, 0), velocity: vec3(0, 0, 0) };
  #aims = false;
  /** A press throws once. */
  #spent = false;
  /** Own floor frame: the ball in its rack, the basket, and where the mouse points above or below it. */
  readonly #rack = vec3(0, 0, 0);
  readonly #basket = vec3(0, 0, 0);
  readonly #target = vec3(0, 0, 0);
  readonly #velocity = vec3(0, 0, 0);

  constructor(body: PlayerBody, steering: () => BallSteering) {
    this.#steering = steering;
    this.#arenaFromFloor = body.arenaFromFloor;
    this.#postures = createPlayerPostures(body);
    this.#moves = new ThrowPostures(this.#postures);
    this.#swung = this.#moves.makeThrow();
  }

  get aim(): Launch | null {
    return this.#aims ? this.#aim : null;
  }

  follow(time: number, sight: BotSight): Performed {
    const wish = this.#steering();
    const elapsed = this.#last === null ? 0 : clamp(time - this.#last, 0, 0.1);
    this.#last = time;
    this.#postures.inFloor(sight.basket ?? sight.state.basket.position, this.#basket);
    ahead(wish.ray, this.#basket.z, this.#target);
    if (!wish.pressed) this.#spent = false;
    const holds = ballInHand(sight.state, sight.player, this.#side) >= 0;
    this.#decide({ time, sight, wish, holds });
    this.#pose(time, sight, elapsed);
    const pressure = this.#pressure(time);
    const left = this.#side === 'left';
    return this.#postures.seen(this.#posture, time, left ? pressure : 0, left ? 0 : pressure);
  }

  #enter(next: Phase, time: number): void {
    this.#phase = next;
    this.#began = time;
    if (next !== 'drawing') this.#aims = false;
  }

  /** Whether another phase begins. */
  #decide(moment: Moment): void {
    const { time } = moment;
    switch (this.#phase) {
      case 'idle':
        this.#choose(moment);
        return;
      case 'reaching':
      case 'taking':
        this.#take(moment);
        return;
      case 'ready':
      case 'drawing':
        this.#prepare(moment);
        return;
      case 'swinging':
        if (time - this.#began >= leadSeconds + this.#swung.seconds) this.#enter('following', time);
        return;
      case 'following':
        if (time - this.#began >= followSeconds) this.#enter('idle', time);
    }
  }

  #choose({ time, sight }: Moment): void {
    const next = nearestBall(sight);
    if (next === null) return;
    this.#ball = next;
    this.#side = this.#findBall(sight).x < 0 ? 'left' : 'right';
    this.#enter('reaching', time);
  }

  #take({ time, sight, holds }: Moment): void {
    const { state } = sight;
    if (this.#phase === 'taking') {
      if (holds) this.#enter('ready', time);
      else if (time - this.#began > takePatience) this.#enter('idle', time);
    } else if (state.phase !== 'running' || state.balls[this.#ball]?.on !== 'rack') this.#enter('idle', time);
    else if (this.#posed && distance(this.#posture[this.#side].fist, this.#findBall(sight)) < atBall)
      this.#enter('taking', time);
  }

  #prepare({ time, wish, holds }: Moment): void {
    if (!holds) this.#enter('idle', time);
    else if (this.#phase === 'ready') {
      if (wish.pressed && !wish.cancelled && !this.#spent) this.#enter('drawing', time);
    } else if (wish.cancelled) {
      this.#spent = true;
      this.#enter('ready', time);
    } else if (!wish.pressed) {
      copyPosture(this.#posture, this.#from);
      this.#enter('swinging', time);
    }
  }

  #pose(time: number, sight: BotSight, elapsed: number): void {
    const moves = this.#moves;
    switch (this.#phase) {
      case 'reaching':
      case 'taking':
        this.#approach(moves.reaching(this.#side, this.#findBall(sight), this.#goal), moveHalfLife, elapsed);
        return;
      case 'ready':
        this.#approach(moves.carrying(this.#side, this.#target, this.#goal), moveHalfLife, elapsed);
        return;
      case 'drawing':
        this.#draw(time);
        this.#approach(this.#swung.wound, windHalfLife, elapsed);
        return;
      case 'swinging':
        this.#swing(time);
        return;
      case 'idle': {
        const at = sight.state.phase === 'running' ? this.#target : this.#basket;
        this.#approach(moves.resting(at, this.#goal), moveHalfLife, elapsed);
      }
    }
  }

  #approach(goal: PlayerPosture, halfLife: number, elapsed: number): void {
    const from = this.#posed ? this.#posture : goal;
    mixPostures(from, goal, smoothingFactor(halfLife, elapsed), this.#posture);
    this.#posed = true;
  }

  /** The throw that is meant after so much of a hold. */
  #draw(time: number): void {
    const share = clamp((time - this.#began) / fullSeconds, 0, 1);
    const from = this.#moves.release(this.#side);
    const target = this.#target;
    const off = subtract(target, from, level);
    normalise(setVec3(level, off.x, 0, off.z), forward, level);
    const above = Math.atan2(target.y - this.#basket.y, Math.abs(target.z - from.z));
    const angle = clamp(usual + lift * above, flattest, steepest);
    const speed = softest + (hardest - softest) * share;
    const velocity = scale(level, speed * Math.cos(angle), this.#velocity);
    velocity.y += speed * Math.sin(angle);
    this.#swung.aim(this.#side, velocity, target);
    this.#moves.leaving(this.#side, normalise(velocity, undefined, level), this.#aim.position);
    transformPoint(this.#arenaFromFloor, this.#aim.position, this.#aim.position);
    rotate(this.#arenaFromFloor.orientation, velocity, this.#aim.velocity);
    this.#aims = true;
  }

  /** From where the arm is to where it swings from, and on as the throw has it. */
  #swing(time: number): void {
    const { wound, thrown, seconds } = this.#swung;
    const here = time - this.#began;
    const since = here - leadSeconds;
    if (since < 0) {
      mixPostures(this.#from, wound, minimumJerk(here / leadSeconds), this.#posture);
      return;
    }
    mixPostures(wound, thrown, minimumJerk(clamp(since / seconds, 0, 1)), this.#posture);
    this.#swung.swing(since, this.#posture[this.#side].fist);
  }

  #pressure(time: number): 0 | 1 {
    if (this.#phase === 'swinging') return time - this.#began - leadSeconds < this.#swung.releaseAt ? 1 : 0;
    return this.#phase === 'taking' || this.#phase === 'ready' || this.#phase === 'drawing' ? 1 : 0;
  }

  /** Where its ball lies in the rack. */
  #findBall({ state }: BotSight): Vec3 {
    return this.#postures.inFloor(rackPosition(this.#ball, state.options.balls, rack), this.#rack);
  }
}

/** Takes ball after ball by itself; swings back while told to, and throws where the ray points. */
export const createSteeredThrower = (body: PlayerBody, steering: () => BallSteering): SteeredPlayer =>
  new SteeredThrower(body, steering);

/** Carries the basket, at its own height, to where the ray points; it leans towards balls by itself. */
export function createSteeredHolder(body: PlayerBody, steering: () => BallSteering): SteeredPlayer {
  const holder = createHolder(body, (home, target) => {
    const { origin, direction } = steering().ray;
    // A ray at the sky means as far as it goes.
    const along = direction.y < -0.02 ? (home.y - origin.y) / direction.y : 20;
    addScaled(origin, direction, clamp(along, 0, 20), target);
    setVec3(target, target.x - home.x, 0, target.z - home.z);
    const far = Math.hypot(target.x, target.z);
    return addScaled(home, target, far > basketReach ? basketReach / far : 1, target);
  });
  return { aim: null, follow: (time, sight) => holder.follow(time, sight) };
}
