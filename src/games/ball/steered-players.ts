import {
  addScaled,
  clamp,
  distance,
  forward,
  type MutableVec3,
  normalise,
  type Ray,
  rotate,
  type Side,
  scale,
  setVec3,
  smoothingFactor,
  subtract,
  type Transform,
  transformPoint,
  type Vec3,
  vec3,
} from 'threepoint/math';
import type { Launch } from '../ballistics';
import { minimumJerk } from '../simulated-body';
import type { SimulatedInput } from '../simulated-input';
import type { BallBot, BotView } from './ball-bot';
import { nearestBall } from './ball-bot';
import {
  copyPosture,
  createPlayerPostures,
  makePosture,
  mixPostures,
  type PlayerBody,
  type PlayerPosture,
  type PlayerPostures,
} from './player-postures';
import { createSimulatedHolder } from './simulated-holder';
import { ballInHand } from './state-selectors';
import { rackPosition } from './stations';
import { ThrowPostures } from './throw-postures';
import { UnderarmThrow } from './underarm-throw';

/** The mouse input that steers a player; own floor frame. */
export interface BallSteering {
  /** The ray of the pointer; its direction is unit. */
  readonly ray: Ray;
  /** A thrower swings back while this is true, and then throws: the longer, the farther. */
  readonly pressed: boolean;
  /** Whether to lower the arm without a throw. */
  readonly cancelled: boolean;
}

/** A player that is steered by a mouse instead of two hands. */
export interface SteeredPlayer extends BallBot {
  /** The launch of the throw that is being aimed, arena frame, the same object in every frame; null: none. */
  readonly aim: Launch | null;
}

/** Time of a press for the hardest throw [s], and speeds of the softest and the hardest throw [m/s]. */
const fullSeconds = 1.3;
const softest = 4;
const hardest = 8.8;
/** Flattest, steepest and usual elevation of a throw [rad]. */
const flattest = 0.45;
const steepest = 1.2;
const usual = 0.85;
/** Gain from the pointer's elevation to that of the throw. */
const lift = 1.5;
/** Half-lives of the motion to a posture [s]. */
const moveHalfLife = 0.07;
const windHalfLife = 0.045;
/** Distance at which a fist takes a ball [m], and how long it waits for the match to confirm [s]. */
const atBall = 0.07;
const takePatience = 0.6;
/** Time to the start of the swing, and after the throw [s]. */
const leadSeconds = 0.1;
const followSeconds = 0.25;
/** Reach of the basket from where it waits [m]. */
const basketReach = 0.65;

/** Writes the point at which a ray meets the vertical plane at `z` [m], clamped to a useful range. */
function ahead({ origin, direction }: Ray, z: number, target: MutableVec3): MutableVec3 {
  const along = direction.z < -0.05 ? (z - origin.z) / direction.z : 20;
  addScaled(origin, direction, clamp(along, 0, 20), target);
  return setVec3(target, clamp(target.x, -4, 4), clamp(target.y, 0, 3.5), z);
}

type Phase = 'idle' | 'reaching' | 'taking' | 'ready' | 'drawing' | 'swinging' | 'following';

interface SteeringFrame {
  time: number;
  sight: BotView;
  input: BallSteering;
  /** Whether the ball is in the throwing hand. */
  holds: boolean;
}

// Scratch of one call.
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
  /** Whether `#posture` is set. */
  #posed = false;
  /** The posture at the start of a swing. */
  readonly #from = makePosture();
  readonly #goal = makePosture();
  #side: Side = 'right';
  #ball = 0;
  readonly #swung: UnderarmThrow;
  readonly #aim = { position: vec3(0, 0, 0), velocity: vec3(0, 0, 0) };
  #aims = false;
  /** Whether the current press has already thrown or been cancelled. */
  #spent = false;
  /** The ball in its rack, the basket, and the pointer's target at the basket's distance; own floor frame. */
  readonly #rack = vec3(0, 0, 0);
  readonly #basket = vec3(0, 0, 0);
  readonly #target = vec3(0, 0, 0);
  readonly #velocity = vec3(0, 0, 0);

  constructor(body: PlayerBody, steering: () => BallSteering) {
    this.#steering = steering;
    this.#arenaFromFloor = body.arenaFromFloor;
    this.#postures = createPlayerPostures(body);
    this.#moves = new ThrowPostures(this.#postures);
    this.#swung = new UnderarmThrow(this.#postures, this.#moves);
  }

  get aim(): Launch | null {
    return this.#aims ? this.#aim : null;
  }

  follow(time: number, sight: BotView): SimulatedInput {
    const input = this.#steering();
    const elapsed = this.#last === null ? 0 : clamp(time - this.#last, 0, 0.1);
    this.#last = time;
    this.#postures.inFloor(sight.basket ?? sight.state.basket.position, this.#basket);
    ahead(input.ray, this.#basket.z, this.#target);
    if (!input.pressed) this.#spent = false;
    const holds = ballInHand(sight.state, sight.player, this.#side) >= 0;
    this.#decide({ time, sight, input, holds });
    this.#pose(time, sight, elapsed);
    const pressure = this.#pressure(time);
    const left = this.#side === 'left';
    return this.#postures.inputFor(this.#posture, time, left ? pressure : 0, left ? 0 : pressure);
  }

  #enter(next: Phase, time: number): void {
    this.#phase = next;
    this.#began = time;
    if (next !== 'drawing') this.#aims = false;
  }

  /** Enters another phase if its condition is met. */
  #decide(moment: SteeringFrame): void {
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

  #choose({ time, sight }: SteeringFrame): void {
    const next = nearestBall(sight);
    if (next === null) return;
    this.#ball = next;
    this.#side = this.#findBall(sight).x < 0 ? 'left' : 'right';
    this.#enter('reaching', time);
  }

  #take({ time, sight, holds }: SteeringFrame): void {
    const { state } = sight;
    if (this.#phase === 'taking') {
      if (holds) this.#enter('ready', time);
      else if (time - this.#began > takePatience) this.#enter('idle', time);
    } else if (state.phase !== 'running' || state.balls[this.#ball]?.on !== 'rack') this.#enter('idle', time);
    else if (this.#posed && distance(this.#posture[this.#side].fist, this.#findBall(sight)) < atBall)
      this.#enter('taking', time);
  }

  #prepare({ time, input, holds }: SteeringFrame): void {
    if (!holds) this.#enter('idle', time);
    else if (this.#phase === 'ready') {
      if (input.pressed && !input.cancelled && !this.#spent) this.#enter('drawing', time);
    } else if (input.cancelled) {
      this.#spent = true;
      this.#enter('ready', time);
    } else if (!input.pressed) {
      copyPosture(this.#posture, this.#from);
      this.#enter('swinging', time);
    }
  }

  #pose(time: number, sight: BotView, elapsed: number): void {
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

  /** Aims the throw by the duration of the press. */
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

  /** Moves the arm to the start of the swing, and then along the throw. */
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

  /** Returns the position of the player's ball in its rack. */
  #findBall({ state }: BotView): Vec3 {
    return this.#postures.inFloor(rackPosition(this.#ball, state.options.balls, rack), this.#rack);
  }
}

/** Creates a thrower that takes balls by itself, and throws where the ray points. */
export const createSteeredThrower = (body: PlayerBody, steering: () => BallSteering): SteeredPlayer =>
  new SteeredThrower(body, steering);

/** Creates a holder that carries the basket to where the ray points; it leans towards balls by itself. */
export function createSteeredHolder(body: PlayerBody, steering: () => BallSteering): SteeredPlayer {
  const holder = createSimulatedHolder(body, (home, target) => {
    const { origin, direction } = steering().ray;
    // A ray into the sky aims as far as possible.
    const along = direction.y < -0.02 ? (home.y - origin.y) / direction.y : 20;
    addScaled(origin, direction, clamp(along, 0, 20), target);
    setVec3(target, target.x - home.x, 0, target.z - home.z);
    const far = Math.hypot(target.x, target.z);
    return addScaled(home, target, far > basketReach ? basketReach / far : 1, target);
  });
  return { aim: null, follow: (time, sight) => holder.follow(time, sight) };
}
