import type { Buttons, Calibration, HapticPulse, TrackingFrame } from 'threepoint/core';
import type { Side } from 'threepoint/math';
import type { SimulatedInput } from 'threepoint-games';
import type {
  BallConnection,
  BallGame,
  BallGestureFrame,
  BallGestures,
  BallRoomView,
  BallSteering,
} from 'threepoint-games/ball';
import type { ConnectionUpdate } from 'threepoint-rooms/room';
import type { MatchFrame } from '../../people/match/match-frame';
import { MatchPlay, type MatchPlayOptions } from '../../people/match/match-play';
import { ballGame } from '../ball-game';
import { BallBots } from './ball-bots';
import type { BallFrame } from './ball-frame';
import type { BallProbe } from './ball-probe';
import { probeOf } from './ball-probe';
import { CourtHands } from './court-hands';
import { joined, SimulatedPlayer } from './simulated-player';
import type { BotKnowledge } from './simulated-seat';
import { createGestures, playFrame } from './simulated-seat';

export interface BallPlayOptions extends MatchPlayOptions<BallGame> {
  /** Whether bots take free seats; read in every frame. */
  bots(): boolean;
  /** The mouse's target, floor frame of the user; null or absent: a simulated player plays. */
  steering?(): BallSteering | null;
  readonly seed: number;
}

const emptyHands: Readonly<Record<Side, number | null>> = { left: null, right: null };

/** A match of the ball game with its bots, without the view. */
export class BallPlay extends MatchPlay<BallGame, BallFrame> {
  readonly #sight: BotKnowledge = { pausedSeconds: 0, opening: null };
  readonly #bots: BallBots;
  readonly #simulated: SimulatedPlayer;
  readonly #hands = new CourtHands();
  #gestures: BallGestures | null = null;
  /** The gestures of this frame; null: no hands were played. */
  #played: BallGestureFrame | null = null;
  #begunAt: number | null = null;
  /** Whether roles are to move on, until the request is sent; null: none waits. */
  #rotateRequest: boolean | null = null;

  constructor(options: BallPlayOptions) {
    super(ballGame, options);
    this.#simulated = new SimulatedPlayer(options, options.visitor.calibration, this.#sight);
    this.#bots = new BallBots(options, this.#sight);
  }

  /** Receives messages from the room and moves the bots. */
  override begin(time: number): ConnectionUpdate<BallGame> {
    if (this.room?.paused && this.#begunAt !== null) this.#sight.pausedSeconds += time - this.#begunAt;
    this.#begunAt = time;
    const update = super.begin(time);
    if (update.changes.length > 0) this.#gestures?.resume();
    this.#gestures?.onEvents(update.events);
    if (this.connection) {
      this.#bots.seat(this.connection, time);
      this.#sendRotateRequest(this.connection);
    }
    this.#bots.move(time);
    return update;
  }

  /**
   * Returns the input of the simulated player on the user's seat at a time [s], or null without a seat. `catchUp`: also
   * plays the moments between two slow frames, which no device could.
   */
  act(time: number, catchUp = true): SimulatedInput | null {
    if (!this.connection) return null;
    return this.#simulated.act(this.connection, this.#gesturesOn(this.connection), time, catchUp);
  }

  /** The user's floor frame changes with the next frame: others see a jump, and hands throw nothing. */
  override discontinuity(): void {
    super.discontinuity();
    this.#gestures?.discontinuity();
  }

  /** Lets roles move on after each match, or stay. */
  override setOption(on: boolean): void {
    this.#rotateRequest = on;
  }

  override away(on: boolean): void {
    super.away(on);
    this.#bots.setAway(on && this.#othersPlay);
  }

  override calibrate(next: Calibration): void {
    this.#simulated.calibrate(next);
    super.calibrate(next);
  }

  override leave(): void {
    this.#bots.leave();
    super.leave();
  }

  probe(): BallProbe | null {
    return this.newest && this.connection && probeOf(this.newest, this.connection);
  }

  protected override playHands(
    connection: BallConnection,
    frame: TrackingFrame,
    buttons: Buttons,
  ): readonly HapticPulse[] {
    this.#played = playFrame(connection, this.#gesturesOn(connection), frame, buttons);
    return this.#played.haptics;
  }

  protected override completeFrame(shared: MatchFrame<BallGame>, connection: BallConnection): BallFrame {
    const { state, me } = shared;
    this.#hands.update(connection, state, this.seated.poses);
    const { palms, opening } = this.#hands;
    this.#sight.opening = opening;
    const missed = this.#simulated.takeMissed();
    const played = this.#played;
    this.#played = null;
    return {
      ...shared,
      role: me === null ? null : (state.players[me]?.role ?? null),
      palms,
      opening,
      cues: joined(missed.cues, played?.cues),
      simulated: missed.botPlayed,
      haptics: joined(missed.haptics, shared.haptics),
      held: played?.held ?? emptyHands,
      aim: this.#simulated.aim,
    };
  }

  /** Whether another person is connected and has a seat. */
  get #othersPlay(): boolean {
    const { seats, mySeat }: Pick<BallRoomView, 'seats' | 'mySeat'> = this.room ?? { seats: [], mySeat: null };
    return seats.some((row, seat) => seat !== mySeat && row !== null && !row.bot && row.presence !== 'gone');
  }

  #gesturesOn(connection: BallConnection): BallGestures {
    this.#gestures ??= createGestures(connection);
    return this.#gestures;
  }

  /** Sends the request once the room takes actions: it is connected and not paused. */
  #sendRotateRequest(connection: BallConnection): void {
    if (this.#rotateRequest === null || connection.status.phase !== 'joined' || connection.room?.paused) return;
    const sequence = this.#gesturesOn(connection).nextSequence();
    connection.sendAction({ type: 'rotate', sequence, rotate: this.#rotateRequest });
    this.#rotateRequest = null;
  }
}
