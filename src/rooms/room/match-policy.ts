import type { Transform } from 'threepoint/core/math/pose';
import type { SeatAction } from 'threepoint/core/tracking/seat-action';

/** What a Room reads of the state of any game. */
export interface MatchState {
  /** Ticks since the match was made. */
  readonly tick: number;
  readonly phase: 'ready' | 'running' | 'over';
  /** By seat. */
  readonly players: readonly { readonly present: boolean; readonly ready: boolean }[];
}

/** The types of a game that a Room can host. */
export interface HostedGame {
  readonly state: MatchState;
  /** What a player does, as their page sends it. */
  readonly action: object;
  readonly event: object;
  /** A state as it is sent. */
  readonly snapshot: unknown;
}

/** What the rules of a game hear: the Room, and each player's own actions with their seat. */
export type MatchAction<Game extends HostedGame> = SeatAction | (Game['action'] & { readonly player: number });

/** A match in progress, stepped in ticks of its own. */
export interface HostedMatch<Game extends HostedGame> {
  readonly state: Game['state'];
  /** Seconds from the end of the last tick stepped to the time advanced to, mostly below 0. */
  readonly lead: number;
  /**
   * Steps every tick that has begun by `time` [s, any monotonic clock; the first call is the start of tick 0] and returns what
   * happened; the actions belong to the tick in which `time` lies.
   */
  advance(time: number, actions: readonly MatchAction<Game>[]): readonly Game['event'][];
}

/** All that a Room must know of the game that is played in it. */
export interface MatchPolicy<Game extends HostedGame> {
  /** The game's name, told to every page that joins. */
  readonly kind: string;
  readonly seats: number;
  /** Seconds of the match that one tick takes. */
  readonly tickSeconds: number;
  /** A match that waits for its players. `rotation`: roles have moved on by this many seats; `onTick`: hears of each tick before it is stepped. */
  start(rotation: number, onTick: (actions: readonly MatchAction<Game>[]) => void): HostedMatch<Game>;
  /**
   * By how many seats roles move on for another match of those present, who all want one: 0 or, if `rotate`, as few as let them play. null: they
   * can play none.
   */
  nextRoles(state: Game['state'], rotate: boolean): number | null;
  snapshot(state: Game['state']): Game['snapshot'];
  /** The action that a page sent, checked field by field; null: it is none of this game's. */
  readAction(value: unknown): Game['action'] | null;
  /** The event that refuses an action because the match's clock stands. */
  refusalInPause(player: number, action: Game['action']): Game['event'];
  /** Whose action this event refuses, and why; null: it is another event, for all to hear. */
  refusalOf(event: Game['event']): { readonly player: number; readonly reason: string } | null;
  /** Where the floor of a seat lies in the arena. */
  arenaFromFloor(seat: number, state: Game['state']): Transform<'arena', 'floor'>;
}
