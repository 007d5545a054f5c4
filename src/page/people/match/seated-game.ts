import type { ClientPolicy, HostedGame, MatchPolicy } from 'threepoint-rooms/room';
import type { TaskEnd } from 'threepoint-study/participant';
import type { ActivityContext } from '../../activity/activity-context';
import type { DisplayedMatch } from '../view/displayed-match';

/** The figures of a match. */
export interface MatchFigures {
  readonly score: number;
  /** The largest possible score. */
  readonly of: number;
  /** The length of a match [s]. */
  readonly seconds: number;
  /** The second of the match at which it began; null: it has not begun. */
  readonly startedAt: number | null;
  /** Why the match ended, as results of studies state it; null: it has not ended. */
  readonly end: TaskEnd['ended'] | null;
}

/** The lobby's texts between two matches. */
export interface LobbyTexts {
  readonly heading: string;
  /** Two lines before a match: what players do, and its terms. */
  readonly about: readonly [string, string];
  /** The text after the score of a match that is over, such as "of 20 caught". */
  readonly result: string;
}

/** An option that the players of a room set together. */
export interface MatchOption<State> {
  readonly label: string;
  /** The label on the lobby's button. */
  readonly shortLabel: string;
  isOn(state: State): boolean;
}

/** A game of several people: what rooms, boards, lists and panels of the page need to know of it. */
export interface SeatedGame<Game extends HostedGame> {
  /** The name of the game's activity, which the address has. */
  readonly name: string;
  readonly policy: ClientPolicy<Game>;
  /** The terms that this page asks of a room; the game's `RoomKind` checks them. */
  terms(switches: ActivityContext['switches']): object;
  /** Returns the match policy of a room in this page, by these terms. */
  matchPolicy(terms: object, seed: number): MatchPolicy<Game>;
  /** The roles of players by station, in the words of labels and lists. */
  readonly roles: readonly string[];
  /** Whether bots of the page can take free seats. */
  readonly bots: boolean;
  /** Returns the station of the player on a seat. */
  stationOf(state: Game['state'], seat: number): number;
  figures(state: Game['state']): MatchFigures;
  /** Returns seconds until the bell. `last`: the seconds at the last frame. */
  secondsLeft(state: Game['state'], last: number): number;
  /** Returns what the bar shows next to the score, such as "12 balls". */
  remainder(state: Game['state']): string;
  lobby(state: Game['state']): LobbyTexts;
  /** Returns a player's own result after a match, such as "3 caught"; null: the game has none. */
  resultOf(state: Game['state'], seat: number): string | null;
  /** Returns which role a match lacks, such as "Waiting for a thrower"; null: it can begin when all are ready. */
  lacks(match: DisplayedMatch<Game['state']>): string | null;
  /** Returns the rules in sentences; `state` null: before the page is in a room. */
  rules(state: Game['state'] | null): readonly string[];
  /** Returns how a player without a headset plays; null: only a headset can. */
  hint(state: Game['state'], seat: number, touch: boolean): string | null;
  readonly option?: MatchOption<Game['state']>;
}
