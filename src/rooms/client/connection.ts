import type { AvatarRef, Calibration } from 'threepoint/core';
import type { Transform } from 'threepoint/math';
import type { Absence, DisconnectReason, SeatInfo } from '../protocol/messages';
import type { PosePacket } from '../protocol/pose-packet';
import type { SignalBody, Voice } from '../protocol/voice-messages';
import type { HostedGame } from '../room/match-policy';

/** The page's clock, by which tracked frames are timed [s]; it never goes back. */
export interface LocalClock {
  now(): number;
  /** The total of the pauses that it skipped [s]; other clocks ran on. */
  readonly skippedSeconds: number;
}

/** The state of a page's connection to its room. */
export interface ConnectionStatus {
  /** ended: for good, see `reason`; nothing more arrives. */
  readonly phase: 'connecting' | 'joined' | 'reconnecting' | 'ended';
  /** Failed attempts since the last connection; 0: none. */
  readonly attempt: number;
  /** Seconds until the next attempt; null: one is under way, or none will be made. */
  readonly retryIn: number | null;
  /** Why it ended, or why the last attempt failed; null: neither has happened. */
  readonly reason: DisconnectReason | 'unreachable' | 'forbidden' | 'refused' | null;
}

/** An absence of players as a page knows it. */
export interface SeenAbsence extends Omit<Absence, 'since' | 'until'> {
  /** Seconds until the match is given up; null: it waits no longer, or without a limit. */
  readonly secondsLeft: number | null;
}

/** The room as this page knows it. */
export interface RoomView<Game extends HostedGame> {
  readonly id: string;
  /** Changes when the server has created the room again and lost its match. */
  readonly epoch: string;
  /** The players by seat number; null: free. */
  readonly seats: readonly (SeatInfo | null)[];
  /** This page's seat, which is also the player's index in the match; null: a spectator. */
  readonly mySeat: number | null;
  readonly spectators: number;
  /**
   * The match, with the player's own actions predicted; null before the first welcome. It has no poses: RemotePlayers
   * has them.
   */
  readonly match: Game['state'] | null;
  /** Response time of the room [s]; null: it runs in this page, or has not answered yet. */
  readonly responseTime: number | null;
  /** Seconds of the match minus seconds of this page's clock. */
  readonly matchClockOffset: number;
  /** Whether a player has paused the match clock. */
  readonly paused: boolean;
  /** The absences for which its matches have waited, oldest first. */
  readonly absences: readonly SeenAbsence[];
  /** The number of welcome messages: one after joining and one after each reconnection. */
  readonly welcomeCount: number;
  /** The number of rounds that were lost because the server was restarted. */
  readonly voidedRounds: number;
}

/** A pose packet of another player. */
export interface ReceivedPose {
  readonly seat: number;
  readonly packet: PosePacket;
  /** Time of arrival by this page's clock [s]. */
  readonly arrivedAt: number;
}

/** What has arrived since the last call. */
export interface ConnectionUpdate<Game extends HostedGame> {
  /** Events of the match, oldest first. Earlier ones are part of the state in the welcome message. */
  readonly events: readonly Game['event'][];
  readonly poses: readonly ReceivedPose[];
  /**
   * Each at most once. welcome: joined or reconnected. match: another round began. voided: see `RoomView.voided`.
   * resumed: the page was hidden, and the events are from that time.
   */
  readonly changes: readonly ('welcome' | 'match' | 'voided' | 'seats' | 'resumed')[];
}

/** The pose of this page's avatar in one frame, as it is sent to the others; floor frame. */
export type OutgoingPose = Omit<PosePacket, 'timeMs'>;

/** Receives voice changes of a room at once instead of with a frame, because a hidden page draws no frames. */
export interface VoiceListener {
  /** Called when the seats have changed, and with them perhaps who takes part in the voices. */
  onSeatsChanged(): void;
  /** Called with a signal from the page that has this voice session. */
  onSignal(from: string, body: SignalBody): void;
}

/** Sends the voice state and signals of a page to the others in its room. */
export interface VoiceChannel {
  /** Sets the own voice; null: takes no part. Sent again after every reconnection. */
  setVoice(voice: Voice | null): void;
  /** Sends a signal to the page with this session; dropped while there is no connection. */
  sendSignal(to: string, body: SignalBody): void;
  /** Sets the listener; null: none. */
  setListener(listener: VoiceListener | null): void;
}

/**
 * A client's connection to a room, whether the Room runs on a server or in this page. Times are the page's clock [s],
 * by which tracked frames are timed.
 */
export interface Connection<Game extends HostedGame> {
  readonly status: ConnectionStatus;
  /** The room; null before the first welcome. It keeps its last state while the connection is lost. */
  readonly room: RoomView<Game> | null;
  /** Returns what has arrived since the last call; to be called once a frame. */
  update(time: number): ConnectionUpdate<Game>;
  /**
   * Sends the pose of a tracked frame at `time`, 30 times a second; to be called once a frame. Spectators send nothing.
   */
  sendPose(time: number, shown: OutgoingPose): void;
  /** Sends an action of the game. It is predicted at once; the Room decides. */
  sendAction(action: Game['action']): void;
  setReady(ready: boolean): void;
  /** Pauses or resumes the match clock; refused unless the room is pausable. Sent again after every reconnection. */
  setPaused(pause: boolean): void;
  setAway(away: boolean): void;
  /** Moves to another free seat; null: becomes a spectator. */
  changeSeat(seat: number | null): void;
  calibrate(calibration: Calibration): void;
  readonly voices: VoiceChannel;
  /** Changes the avatar. Sent again after every reconnection. */
  setAvatar(avatar: AvatarRef): void;
  /** Returns the transform from a seat's floor to the arena. */
  arenaFromFloor(seat: number): Transform<'arena', 'floor'>;
  /** Gives up the seat and ends the connection. */
  leave(): void;
}

/** The person or bot who joins. */
export interface Visitor {
  readonly name: string;
  readonly calibration: Calibration;
  /** Default: the plain avatar. */
  readonly avatar?: AvatarRef;
  /** Whether to join as a spectator. Default: false. */
  readonly spectate?: boolean;
  /** A bot yields its seat to a person who finds no other, and is shown as a bot. Default: false. */
  readonly bot?: boolean;
  /** The wanted seat. Default: the first free one. */
  readonly seat?: number;
}
