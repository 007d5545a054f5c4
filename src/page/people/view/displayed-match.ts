import type { MatchState } from 'threepoint-rooms/room';
import type { SeatFrame } from '../match/match-frame';
import { seatLooks } from './seat-looks';

/** A player on a seat, as boards and labels write of them. */
export type DisplayedPlayer = Pick<SeatFrame, 'name' | 'bot' | 'presence' | 'me' | 'station'>;

/** A match as boards show it: the state of this frame and the person on each seat. */
export interface DisplayedMatch<State extends MatchState = MatchState> {
  readonly state: State;
  /** Whole seconds until the bell, rounded up. */
  readonly seconds: number;
  readonly players: readonly (DisplayedPlayer | null)[];
  /** The user's player; null: a spectator. */
  readonly me: number | null;
  /** The user is ready without being asked. */
  readonly readyByItself: boolean;
}

/** Returns the players that the match can wait for. The seat of one who has left is held, but no match waits for it. */
export const presentPlayers = ({ state, players }: DisplayedMatch): readonly number[] =>
  players.flatMap((person, player) => (person && state.players[player]?.present ? [player] : []));

/** The displayed name of the user if none was given. */
export const ownName = 'You';

/** Returns a name that marks bots as such, to be shown next to the mark of the player's station. */
export const displayName = ({ name, bot }: Pick<DisplayedPlayer, 'name' | 'bot'>): string =>
  bot && !/\bbot\b/i.test(name) ? `${name} (bot)` : name;

/**
 * Returns a name in a text, after the mark of the player's station. Players may choose equal names, or names that look
 * alike, but not the mark.
 */
export const markedName = (player: Pick<DisplayedPlayer, 'name' | 'bot' | 'station'>): string =>
  `${seatLooks[player.station]?.mark ?? ''} · ${displayName(player)}`;
