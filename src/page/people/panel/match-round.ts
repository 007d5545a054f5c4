import type { RoomClient } from 'threepoint-rooms';
import { bannerText, connectionText } from 'threepoint-rooms/internal';
import type { HostedGame } from 'threepoint-rooms/room';
import type { MatchFrame } from '../match/match-frame';
import type { SeatedGame } from '../match/seated-game';
import { displayName, markedName } from '../view/displayed-match';
import { waitingSentence } from '../view/waiting-sentence';
import type { PersonVoice, VoicesState } from '../voices/voices-state';
import type { SeatRow } from './other-players';

/** A match as panels and menus show it. */
export interface MatchRound {
  readonly phase: 'ready' | 'running' | 'over';
  readonly score: number;
  readonly of: number;
  /** What is left to play, such as "12 balls". */
  readonly remainder: string;
  /** Seconds until the bell; after a match, the seconds that were left at its end. */
  readonly secondsLeft: number;
  /** The clock is stopped. */
  readonly paused: boolean;
  /** A sentence about what the match waits for; null: it waits for nothing. */
  readonly waiting: string | null;
  /** The quality of the connection in words; null: it is lost, or the room is in this page. */
  readonly connection: string | null;
  /** This page is in the room and connected to it: the room receives what the user presses. */
  readonly joined: boolean;
  /** Why this page is no longer in the room; null: it is in the room. */
  readonly ended: string | null;
  readonly rules: readonly string[];
  /** How the user plays without a headset, with a mouse and by touch; null: not at all. */
  readonly hints: { readonly mouse: string | null; readonly touch: string | null };
  readonly role: string;
  /** The user's seat; null: a spectator. */
  readonly seat: number | null;
  readonly ready: boolean;
  /** Whether the game's option is on. */
  readonly option: boolean;
  readonly spectators: number;
  /** All seats; `free`: a person can take it. */
  readonly people: readonly (SeatRow & { readonly free: boolean })[];
  readonly voices: VoicesState;
}

export interface MatchRoundParts<Game extends HostedGame> {
  readonly play: Pick<RoomClient<Game>, 'status' | 'room'>;
  readonly frame: MatchFrame<Game>;
  /** The user is ready without being asked. */
  readonly readyByItself: boolean;
  readonly voices: { readonly state: VoicesState; readonly seats: { voiceOf(seat: number): PersonVoice } };
}

/** Summarises a frame of a match. */
export function matchRound<Game extends HostedGame>(
  game: SeatedGame<Game>,
  { play, frame, readyByItself, voices }: MatchRoundParts<Game>,
): MatchRound {
  const { state, secondsLeft, me, players, spectators, paused } = frame;
  const { phase } = play.status;
  const ended = phase === 'ended';
  // Without a connection the state is outdated, and the banner says so.
  const joined = phase === 'joined';
  const delay = joined ? (play.room?.responseTime ?? null) : null;
  const roleOf = (seat: number) => game.roles[game.stationOf(state, seat)] ?? '';
  const hint = (touch: boolean) => (me === null ? null : game.hint(state, me, touch));
  const { score, of } = game.figures(state);
  const standing = { state, seconds: Math.ceil(secondsLeft), players, me, readyByItself };
  return {
    phase: state.phase,
    score,
    of,
    remainder: game.remainder(state),
    secondsLeft,
    paused,
    waiting: joined ? waitingSentence(game, standing) : null,
    connection: delay === null ? null : connectionText(delay),
    joined,
    ended: ended ? (bannerText(play.status) ?? 'The connection has ended.') : null,
    rules: game.rules(state),
    hints: { mouse: hint(false), touch: hint(true) },
    role: me === null ? 'Watching' : roleOf(me),
    seat: me,
    ready: me !== null && (state.players[me]?.ready ?? false),
    option: game.option?.isOn(state) ?? false,
    spectators,
    people: players.map((player, seat) => ({
      seat,
      name: player && (player.me ? player.name : displayName(player)),
      station: game.stationOf(state, seat),
      label: player ? markedName(player) : '',
      role: roleOf(seat),
      free: player === null || (player.bot && !player.me),
      ...voices.seats.voiceOf(seat),
    })),
    voices: voices.state,
  };
}
