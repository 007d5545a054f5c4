import type { Calibration } from 'threepoint/core/body/calibration';
import type { WornAvatar } from 'threepoint/core/body/worn-avatar';
import type { Transform } from 'threepoint/core/math/pose';
import type { DisconnectReason, SeatInfo } from '../protocol/messages';
import type { PosePacket } from '../protocol/pose-packet';
import type { SignalBody, Voice } from '../protocol/voice-messages';
import type { HostedGame } from '../room/match-policy';

/** This page's clock, that of the tracked frames [s]; it never goes back. */
export interface LocalClock {
  now(): number;
  /** What it left out of the page's pauses in all [s]: other clocks went on meanwhile. */
  readonly leftOut: number;
}

/** How it stands between this page and its room. */
export interface ConnectionStatus {
  /** ended: for good, see `reason`; nothing more comes. */
  readonly phase: 'connecting' | 'joined' | 'reconnecting' | 'ended';
  /** Attempts since the connection was last whole; 0: none needed. */
  readonly attempt: number;
  /** Seconds until the next attempt; null: one is under way, or none will be made. */
  readonly retryIn: number | null;
  /** Why it ended, or why the last attempt failed; null: nothing to tell. */
  readonly reason: DisconnectReason | 'unreachable' | 'refused' | null;
}

/** The room as it is known here. */
export interface RoomView<Game extends HostedGame> {
  readonly id: string;
  /** Another one where the room was made anew under its name, and what was played in it is forgotten. */
  readonly epoch: string;
  /** By seat number; null: free. */
  readonly seats: readonly (SeatInfo | null)[];
  /** Ours; null: a spectator. Also the player's index in the match. */
  readonly mySeat: number | null;
  readonly spectators: number;
  /** Roles move on with every rematch. */
  readonly rotate: boolean;
  /**
   * The match with the player's own actions as they turn out if the rules allow them; null before the first welcome. The poses of the players
   * are not in it: RemotePlayers has them.
   */
  readonly match: Game['state'] | null;
  /** How long the room takes to answer [s]; null: it is in this page, or has not answered yet. */
  readonly delay: number | null;
  /** Seconds of the match minus seconds of this page's clock. */
  readonly matchAhead: number;
  /** The match's clock stands because a player stopped it. */
  readonly paused: boolean;
  /** How often the room has been known afresh, after joining and after each return. */
  readonly welcomes: number;
  /** How many rounds were cut short because the room had forgotten them (its server was restarted). */
  readonly voided: number;
}

/** A pose packet of another player. */
export interface ArrivedPose {
  readonly seat: number;
  readonly packet: PosePacket;
  /** By this page's clock [s]. */
  readonly arrivedAt: number;
}

/** What came since the last call. */
export interface ConnectionUpdate<Game extends HostedGame> {
  /** What happened in the match, oldest first. Not what happened before we came: that is in the match as it was told. */
  readonly events: readonly Game['event'][];
  readonly poses: readonly ArrivedPose[];
  /** welcome: the room is known afresh, after joining or returning. match: another round began. voided: see `RoomView.voided`. */
  readonly news: readonly ('welcome' | 'match' | 'voided' | 'seats')[];
}

/** What one frame of this avatar shows to the others, floor frame. */
export type ShownPose = Omit<PosePacket, 'timeMs'>;

/** What a room says of its voices: told at once and not with a frame, as a page that is hidden draws none. */
export interface VoiceListener {
  /** The room's seats are known anew: others may take part or no longer. */
  onSeatsChanged(): void;
  /** The page with this session among the voices has something to say about the connection to it. */
  onSignal(from: string, body: SignalBody): void;
}

/** How a page sets up its voices with the others of its room. */
export interface VoiceChannel {
  /** Takes part as this says; null: not. Said again after every return. */
  setVoice(voice: Voice | null): void;
  /** To the page with this session; lost without a word while there is no connection. */
  signal(to: string, body: SignalBody): void;
  /** One listener; null: none. */
  listen(listener: VoiceListener | null): void;
}

/**
 * A place in a room, whether the Room runs on a server or in this page. Times are this page's clock [s], that of the tracked frames.
 */
export interface Connection<Game extends HostedGame> {
  readonly status: ConnectionStatus;
  /** null: never joined yet. Kept, as it was, while the connection is lost. */
  readonly room: RoomView<Game> | null;
  /** Once a frame: what came since the last call. */
  update(time: number): ConnectionUpdate<Game>;
  /** Once a frame; sends 30 of them a second. `time`: of the tracked frame. Nothing while a spectator or not connected. */
  sendPose(time: number, shown: ShownPose): void;
  /** Sends an action in the game: it is predicted at once and judged by the Room. */
  act(action: Game['action']): void;
  ready(ready: boolean): void;
  rotate(rotate: boolean): void;
  /** Wants the match's clock to stand; refused where the room's terms do not allow it. Said again after every return. */
  pause(pause: boolean): void;
  away(away: boolean): void;
  /** Another seat that is free; null: watch. */
  sit(seat: number | null): void;
  calibrate(calibration: Calibration): void;
  readonly voices: VoiceChannel;
  /** To be seen with another avatar from now on. Said again after every return. */
  wear(avatar: WornAvatar): void;
  /** Where a seat's floor lies in the arena. */
  arenaFromFloor(seat: number): Transform<'arena', 'floor'>;
  /** Gives the seat up; the connection has ended. */
  leave(): void;
}

/** Who joins, and as what. */
export interface Visitor {
  readonly name: string;
  readonly calibration: Calibration;
  /** Absent: the plain one. */
  readonly avatar?: WornAvatar;
  /** Watches only. */
  readonly spectate?: boolean;
  /** Is no person: gives its seat to the first person who finds none, and is marked. */
  readonly bot?: boolean;
  /** A seat rather than the first that is free. */
  readonly seat?: number;
}
