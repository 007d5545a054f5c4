import type { HapticPulse, RemotePerson } from 'threepoint/core';
import type { Vec3 } from 'threepoint/math';
import type { ConnectionStatus, HostedGame } from 'threepoint-rooms/room';

/** A person or bot on a seat in one frame. The head is the same object in every frame: copy what must stay. */
export interface SeatFrame {
  readonly name: string;
  readonly bot: boolean;
  readonly presence: 'here' | 'away' | 'gone';
  readonly me: boolean;
  /** The number of the station in the game, which has the role and the look. */
  readonly station: number;
  readonly ready: boolean;
  /** The position of the head, arena frame; null: it is not visible now. */
  readonly head: Vec3 | null;
  /** 1: live; less: a ghost. */
  readonly opacity: number;
}

/** The result of one frame of a match, for view, sound and haptics. */
export interface MatchFrame<Game extends HostedGame = HostedGame> {
  readonly state: Game['state'];
  /** The epoch of the match's room, see `RoomView.epoch`. */
  readonly epoch: string;
  /** The phase of the connection. Unless it is joined, the state may be outdated. */
  readonly connection: ConnectionStatus['phase'];
  /** Seconds of the match. */
  readonly time: number;
  /** Seconds until the bell; after a match, the seconds that were left at its end. */
  readonly secondsLeft: number;
  readonly me: number | null;
  readonly spectators: number;
  /** A player has paused the match's clock. */
  readonly paused: boolean;
  /** By player; null: the seat is free. */
  readonly players: readonly (SeatFrame | null)[];
  readonly bodies: readonly RemotePerson[];
  readonly events: readonly Game['event'][];
  /** The page was hidden before this frame, and the events are from that time: their sounds are over. */
  readonly resumed: boolean;
  readonly haptics: readonly HapticPulse[];
}
