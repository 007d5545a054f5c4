import type { SeatAction } from 'threepoint/core';
import type { Transform } from 'threepoint/math';

/** The part of a game's state that a Room reads. */
export interface MatchState {
  /** Ticks since the match was created. */
  readonly tick: number;
  readonly phase: 'ready' | 'running' | 'over';
  /** The players by seat. */
  readonly players: readonly { readonly present: boolean; readonly ready: boolean }[];
}

/** The types of a game that a Room can host. */
export interface HostedGame {
  readonly state: MatchState;
  /** An action of a player, as the page sends it. */
  readonly action: object;
  readonly event: object;
  /** A state in the form in which it is sent. */
  readonly snapshot: unknown;
}

/** An input of a game's rules: from the Room, or a player's action with the seat. */
export type MatchAction<Game extends HostedGame> = SeatAction | (Game['action'] & { readonly player: number });

/** A match in progress, which is stepped in fixed ticks. */
export interface HostedMatch<Game extends HostedGame> {
  readonly state: Game['state'];
  /** Seconds from the end of the last tick to the time of the last `advance`, usually negative. */
  readonly lead: number;
  /**
   * Steps every tick that has begun by `time` [s, any monotonic clock; the first call starts tick 0], and returns the
   * events. The actions belong to the tick in which `time` lies.
   */
  advance(time: number, actions: readonly MatchAction<Game>[]): readonly Game['event'][];
}

/** What a Room needs of its game: seats, rules, snapshot and actions. */
export interface MatchPolicy<Game extends HostedGame> {
  /** The name of the game, which every welcome message contains. */
  readonly kind: string;
  readonly seats: number;
  /** Length of a tick [s]. */
  readonly tickSeconds: number;
  /**
   * For how long the clock of a running match stands for players who are away, until another match replaces it [s];
   * absent: matches run on without them.
   */
  readonly waitSeconds?: number;
  /** Creates a match that waits for its players. `onTick` is called before each tick with its actions. */
  start(onTick: (actions: readonly MatchAction<Game>[]) => void): HostedMatch<Game>;
  /** Creates another match after one that is over; null: the players present cannot play one. */
  next(state: Game['state'], onTick: (actions: readonly MatchAction<Game>[]) => void): HostedMatch<Game> | null;
  snapshot(state: Game['state']): Game['snapshot'];
  /** Returns the validated action that a page sent; null: it is not one of this game. */
  readAction(value: unknown): Game['action'] | null;
  /** Returns the event that refuses an action during a pause. */
  refusalInPause(player: number, action: Game['action']): Game['event'];
  /**
   * Returns the player whose action an event refuses, and why; null: it is another event, which all clients receive.
   */
  refusalOf(event: Game['event']): { readonly player: number; readonly reason: string } | null;
  /** Returns the transform from a seat's floor to the arena. */
  arenaFromFloor(seat: number, state: Game['state']): Transform<'arena', 'floor'>;
}
