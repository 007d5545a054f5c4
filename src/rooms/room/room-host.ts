import type { DisconnectReason, RoomMessage } from '../protocol/messages';
import type { SeatPose } from '../protocol/pose-frame';
import type { HostedGame, MatchAction } from './match-policy';

/** The id of one connection; a person who reconnects has another one. */
export type ClientId = string;

/** Why a Room refuses a request; actions that the rules refuse have reasons of the game. */
export type RejectionReason =
  | 'too-fast'
  | 'occupied'
  | 'too-often'
  | 'no-seat'
  | 'not-joined'
  | 'joined-already'
  | 'not-pausable'
  | 'assigned'
  | 'no-voices'
  | 'session-taken'
  | 'no-receiver';

/** A request that the Room has refused. */
export interface RoomRejection {
  readonly client: ClientId;
  readonly seat: number | null;
  readonly what: 'pose' | 'action' | 'sit' | 'message';
  /** A RejectionReason, or a reason of the game's rules. */
  readonly reason: string;
}

/** A pose packet to forward, and the connection from which it came; null: that has ended. */
export interface FreshPose extends SeatPose {
  readonly from: ClientId | null;
}

/** What a Room needs of its host. It calls these only from within its own methods. */
export interface RoomHost<Game extends HostedGame> {
  /** Sends a message, reliably and in order. */
  send(to: ClientId, message: RoomMessage<Game>): void;
  /** Sends a message to all clients that have joined, reliably and in order. */
  broadcast(message: RoomMessage<Game>): void;
  /**
   * Sends the packets since the last call, at least one, by seat: to all clients that have joined, except each one's
   * own.
   */
  sendPoses(poses: readonly FreshPose[]): void;
  /** Disconnects a client that the Room has removed. */
  disconnect(client: ClientId, reason: DisconnectReason): void;
  rejected(rejection: RoomRejection): void;
  /** Called with the actions of every tick before it is stepped; they suffice to replay a match. */
  stepped?(actions: readonly MatchAction<Game>[]): void;
}
