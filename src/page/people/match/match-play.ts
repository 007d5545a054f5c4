import type { Buttons, Calibration, HapticPulse, TrackingFrame } from 'threepoint/core';
import { RoomClient } from 'threepoint-rooms';
import type { Connection, ConnectionUpdate, HostedGame, Visitor } from 'threepoint-rooms/room';
import { ownName } from '../view/displayed-match';
import type { MatchFrame } from './match-frame';
import type { SeatedGame } from './seated-game';
import { SeatedPeople } from './seated-people';

export interface MatchPlayOptions<Game extends HostedGame> {
  connect(visitor: Visitor, time: number): Connection<Game>;
  readonly visitor: Visitor;
  /** The user joined without a name, and reads “You” instead of the one that others see. */
  readonly unnamed?: boolean;
  /** Whether this player is ready without being asked: a simulated one in a room of this page. */
  readyByItself(): boolean;
}

/** A simulated player is ready after this time [s]. */
export const readyAfter = 1;
/** The time for which a person can read a result before a simulated player asks for another round [s]. */
const rematchAfter = 7;

const none: readonly never[] = [];

/** A page's client of a match of several people, without the view. A game extends it with its gestures. */
export abstract class MatchPlay<
  Game extends HostedGame,
  Frame extends MatchFrame<Game> = MatchFrame<Game>,
> extends RoomClient<Game> {
  newest: Frame | null = null;
  protected readonly seated: SeatedPeople<Game>;
  readonly #game: SeatedGame<Game>;
  readonly #options: MatchPlayOptions<Game>;
  #events: readonly Game['event'][] = none;
  #resumed = false;
  #secondsLeft = 0;
  /** Since when the match has been waiting in this phase for a player to be ready [s]. */
  #waitingSince: { readonly phase: string; readonly at: number } | null = null;

  constructor(game: SeatedGame<Game>, options: MatchPlayOptions<Game>) {
    super((time) => options.connect(options.visitor, time));
    this.#game = game;
    this.#options = options;
    this.seated = new SeatedPeople(game, options.unnamed ? ownName : null);
  }

  /** Plays the hands of a frame: sends the actions of their gestures. Returns haptic pulses. */
  protected abstract playHands(
    connection: Connection<Game>,
    frame: TrackingFrame,
    buttons: Buttons,
  ): readonly HapticPulse[];

  /** Returns a frame of the match with what this game adds. */
  protected abstract completeFrame(shared: MatchFrame<Game>, connection: Connection<Game>): Frame;

  /** Receives messages from the room. Call it first in every frame. */
  begin(time: number): ConnectionUpdate<Game> {
    const update = this.update(time);
    if (update.changes.includes('resumed')) this.#resumed = true;
    if (update.events.length > 0) this.#events = [...this.#events, ...update.events];
    this.#readyByItself(time);
    return update;
  }

  /** Advances the match by a tracked frame and its buttons. `frame`: null if nothing is tracked, or for a spectator. */
  follow(time: number, frame: TrackingFrame | null, buttons: Buttons): Frame | null {
    const { connection } = this;
    const before = connection?.room;
    if (!connection || !before?.match) {
      this.newest = null;
      return null;
    }
    const me = before.mySeat;
    const haptics = frame && me !== null ? this.playHands(connection, frame, buttons) : none;
    const seen = connection.room ?? before;
    const state = seen.match ?? before.match;
    this.seated.update(connection, seen, frame, this.people);
    this.#secondsLeft = this.#game.secondsLeft(state, this.#secondsLeft);
    const shared: MatchFrame<Game> = {
      state,
      epoch: before.epoch,
      connection: connection.status.phase,
      time: time + before.matchClockOffset,
      secondsLeft: this.#secondsLeft,
      me,
      spectators: before.spectators,
      paused: before.paused,
      players: this.seated.players,
      bodies: this.seated.bodies,
      events: this.#events,
      resumed: this.#resumed,
      haptics,
    };
    this.newest = this.completeFrame(shared, connection);
    this.#events = none;
    this.#resumed = false;
    return this.newest;
  }

  /** Sets the game's option for the room; absent: the game has none. */
  setOption?(on: boolean): void;

  away(on: boolean): void {
    this.connection?.setAway(on);
  }

  calibrate(next: Calibration): void {
    this.connection?.calibrate(next);
  }

  leave(): void {
    this.connection?.leave();
  }

  /** Reports a simulated player as ready. */
  #readyByItself(time: number): void {
    const seen = this.room;
    const match = seen?.match;
    if (!match || seen.mySeat === null || match.phase === 'running') {
      this.#waitingSince = null;
      return;
    }
    if (this.#waitingSince?.phase !== match.phase) this.#waitingSince = { phase: match.phase, at: time };
    if (!this.#options.readyByItself() || match.players[seen.mySeat]?.ready) return;
    const patience = match.phase === 'over' ? rematchAfter : readyAfter;
    if (time - this.#waitingSince.at > patience && match.players.filter(({ present }) => present).length > 1) {
      this.connection?.setReady(true);
    }
  }
}
