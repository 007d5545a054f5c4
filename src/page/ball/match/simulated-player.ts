import { type Calibration, createEstimator, type HapticPulse } from 'threepoint/core';
import { zero } from 'threepoint/math';
import type { Launch, SimulatedInput } from 'threepoint-games';
import {
  type BallBot,
  type BallConnection,
  type BallCue,
  type BallGestures,
  type BallRoomView,
  type BallSteering,
  createSteeredHolder,
  createSteeredThrower,
  holderStation,
  type SteeredPlayer,
} from 'threepoint-games/ball';
import type { BotKnowledge } from './simulated-seat';
import {
  bodyAt,
  createSimulatedPlayer,
  playFrame,
  simulatedInput,
  stationOf,
  stepSimulated,
  stepTimes,
} from './simulated-seat';

const idle: BallSteering = {
  ray: { origin: zero, direction: { x: 0, y: 0, z: -1 } },
  pressed: false,
  cancelled: false,
};

interface CurrentPlayer {
  readonly station: number;
  readonly eyeHeight: number;
  /** The situation in which the player was created. Another one needs another player. */
  readonly since: 'mouse' | 'ready' | 'later';
  readonly bot: BallBot | SteeredPlayer;
}

const none: readonly never[] = [];

export interface SimulatedPlayerOptions {
  /** The mouse's target, floor frame of the user; null or absent: a bot plays. */
  steering?(): BallSteering | null;
  readonly seed: number;
}

/** The player on the user's seat while no person wears a headset: a bot, or a body that follows the mouse. */
export class SimulatedPlayer {
  readonly #options: SimulatedPlayerOptions;
  readonly #sight: BotKnowledge;
  /** Solves the bodies of moments between two pictures. */
  readonly #between;
  #calibration: Calibration;
  #current: CurrentPlayer | null = null;
  #steering: BallSteering | null = null;
  #actedAt: number | null = null;
  #cues: readonly BallCue[] = none;
  #haptics: readonly HapticPulse[] = none;
  #botPlayed = false;

  constructor(options: SimulatedPlayerOptions, calibration: Calibration, sight: BotKnowledge) {
    this.#options = options;
    this.#sight = sight;
    this.#calibration = calibration;
    this.#between = createEstimator('ik', calibration);
  }

  /** The flight of the ball that the mouse aims, arena frame; null: it aims none. */
  get aim(): Launch | null {
    return this.#steering && this.#current && 'aim' in this.#current.bot ? this.#current.bot.aim : null;
  }

  calibrate(calibration: Calibration): void {
    this.#calibration = calibration;
    this.#between.calibrate(calibration);
    this.#current = null;
  }

  /**
   * Returns the player's input at a time [s], or null without a seat. `catchUp`: also plays the moments between two
   * slow pictures, which no device could.
   */
  act(connection: BallConnection, gestures: BallGestures, time: number, catchUp: boolean): SimulatedInput | null {
    const view = connection.room;
    if (!view?.match || view.mySeat === null) return null;
    this.#steering = this.#options.steering?.() ?? null;
    this.#botPlayed = this.#steering === null;
    const { bot, replaced } = this.#player(view, view.mySeat);
    if (replaced) {
      // The move from the previous hands to these is not a throw.
      const { frame, buttons } = simulatedInput(bot, time, view.match, view.mySeat, this.#sight);
      playFrame(connection, gestures, { ...frame, suspended: true }, buttons);
      this.#actedAt = time;
    }
    if (catchUp) this.#catchUp(connection, gestures, bot, time);
    return simulatedInput(bot, time, connection.room?.match ?? view.match, view.mySeat, this.#sight);
  }

  /** Returns cues and haptics of the moments between two pictures, and whether a bot played in this one, once. */
  takeMissed() {
    const missed = { cues: this.#cues, haptics: this.#haptics, botPlayed: this.#botPlayed };
    this.#cues = none;
    this.#haptics = none;
    this.#botPlayed = false;
    return missed;
  }

  /**
   * Replaces the player for another station, another body or another source of input. A running match keeps its player
   * of the same source.
   */
  #player(view: BallRoomView, seat: number): { readonly bot: CurrentPlayer['bot']; readonly replaced: boolean } {
    const current = this.#current;
    const { eyeHeight } = this.#calibration;
    const station = stationOf(view, seat);
    const phase = view.match?.phase;
    const since = this.#steering ? 'mouse' : phase === 'ready' ? 'ready' : 'later';
    const replaced = current !== null && 'aim' in current.bot !== (this.#steering !== null);
    const same = current?.station === station && current.eyeHeight === eyeHeight && current.since === since;
    if (current && (same || (!replaced && phase === 'running'))) return { bot: current.bot, replaced };
    const bot = this.#steering
      ? this.#steered(station)
      : createSimulatedPlayer(station, this.#calibration, this.#options.seed + seat);
    this.#current = { station, eyeHeight, since, bot };
    return { bot, replaced };
  }

  #steered(station: number): SteeredPlayer {
    const create = station === holderStation ? createSteeredHolder : createSteeredThrower;
    return create(bodyAt(station, this.#calibration), () => this.#steering ?? idle);
  }

  /** Plays the moments before the current picture. */
  #catchUp(connection: BallConnection, gestures: BallGestures, actor: BallBot, time: number): void {
    const moments = stepTimes(time, this.#actedAt);
    this.#actedAt = time;
    const seat = { connection: connection, gestures, player: actor, estimator: this.#between };
    for (let i = 0; i < moments.length - 1; i++) {
      const done = stepSimulated(seat, moments[i]!, this.#sight);
      this.#cues = joined(this.#cues, done?.cues);
      this.#haptics = joined(this.#haptics, done?.haptics);
    }
  }
}

/** Joins two lists, without a copy if one is empty. */
export function joined<T>(a: readonly T[], b: readonly T[] = none): readonly T[] {
  if (a.length === 0) return b;
  return b.length === 0 ? a : [...a, ...b];
}
