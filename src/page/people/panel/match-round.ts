import { type BallState, ballsLeft } from 'threepoint-games/ball';
import { bannerText, connectionText } from 'threepoint-rooms';
import type { BallFrame } from '../../ball/match/ball-frame';
import type { BallPlay } from '../../ball/match/ball-play';
import { waitingSentence } from '../../ball/view/match-texts';
import { displayName, markedName } from '../view/displayed-match';
import { roleTexts } from '../view/seat-looks';
import type { PersonVoice, VoicesState } from '../voices/voices-state';
import type { SeatRow } from './other-players';

/** A match as panels and menus show it. */
export interface BallRound {
  readonly phase: 'ready' | 'running' | 'over';
  readonly score: number;
  readonly of: number;
  readonly ballsLeft: number;
  /** Seconds until the bell; after a match, the seconds that were left at its end. */
  readonly secondsLeft: number;
  /** The length of a match [s]. */
  readonly seconds: number;
  /** The clock is stopped. */
  readonly paused: boolean;
  /** A sentence about what the match waits for; null: it waits for nothing. */
  readonly waiting: string | null;
  /** The quality of the connection in words; null: the room is in this page. */
  readonly connection: string | null;
  /** Why this page is no longer in the room; null: it is in the room. */
  readonly ended: string | null;
  /** The user is a thrower. */
  readonly throws: boolean;
  readonly role: string;
  /** The user's seat; null: a spectator. */
  readonly seat: number | null;
  readonly ready: boolean;
  readonly rotate: boolean;
  readonly spectators: number;
  /** All seats; `free`: a person can take it. */
  readonly people: readonly (SeatRow & { readonly free: boolean })[];
  readonly voices: VoicesState;
}

export interface BallRoundParts {
  readonly play: Pick<BallPlay, 'status' | 'room'>;
  readonly frame: BallFrame;
  /** The players with the names that this page shows. */
  readonly players: BallFrame['players'];
  /** A simulated player has the user's seat. */
  readonly acting: boolean;
  readonly voices: { readonly state: VoicesState; readonly seats: { voiceOf(seat: number): PersonVoice } };
}

const stationOf = (state: BallState, player: number): number => state.players[player]?.station ?? player;
const roleOf = (state: BallState, player: number): string => roleTexts[stationOf(state, player)] ?? '';

/** Summarises a frame of a match. */
export function ballRound({ play, frame, players, acting, voices }: BallRoundParts): BallRound {
  const { state, secondsLeft, me, spectators, paused } = frame;
  const ended = play.status.phase === 'ended';
  const own = me === null ? null : state.players[me];
  const standing = { state, seconds: Math.ceil(secondsLeft), players, me, acting };
  const delay = play.room?.responseTime ?? null;
  return {
    phase: state.phase,
    score: state.score,
    of: state.options.balls,
    ballsLeft: ballsLeft(state),
    secondsLeft,
    seconds: state.options.seconds,
    paused,
    waiting: ended ? null : waitingSentence(standing),
    connection: delay === null || ended ? null : connectionText(delay),
    ended: ended ? (bannerText(play.status) ?? 'The connection has ended.') : null,
    throws: own?.role === 'thrower',
    role: me === null ? 'Watching' : roleOf(state, me),
    seat: me,
    ready: own?.ready ?? false,
    rotate: state.rotate,
    spectators,
    people: players.map((player, seat) => ({
      seat,
      name: player && (player.me ? player.name : displayName(player)),
      station: stationOf(state, seat),
      label: player ? markedName(player) : '',
      role: roleOf(state, seat),
      free: player === null || (player.bot && !player.me),
      ...voices.seats.voiceOf(seat),
    })),
    voices: voices.state,
  };
}
