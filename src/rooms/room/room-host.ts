import type { DisconnectReason, RoomMessage } from '../protocol/messages';
import type { SeatPose } from '../protocol/pose-frame';
import type { HostedGame, MatchAction } from './match-policy';

/** One connection; a person who comes back has another one. */
export type ClientId = string;

/** Why a Room refuses something; an action that the rules refuse has a reason of the game's. */
export type RefusalReason =
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

/** Something that the Room would not do. */
export interface RoomRefusal {
  readonly client: ClientId;
  readonly seat: number | null;
  readonly what: 'pose' | 'action' | 'sit' | 'message';
  /** A RoomReason, or one of the game's rules. */
  readonly reason: string;
}

/** A pose packet that is to be passed on, and by which connection it came; null: that has ended since. */
export interface FreshPose extends SeatPose {
  readonly from: ClientId | null;
}

/** How a Room speaks. Called from within its methods, never at another time. */
export interface RoomHost<Game extends HostedGame> {
  /** Reliable and in order. */
  send(to: ClientId, message: RoomMessage<Game>): void;
  /** The same to all who have joined. */
  broadcast(message: RoomMessage<Game>): void;
  /** To all who have joined, to each but their own: the packets that have come since the last call, seat by seat. At least one. */
  sendPoses(poses: readonly FreshPose[]): void;
  /** The Room has forgotten this client. */
  disconnect(client: ClientId, reason: DisconnectReason): void;
  refused(refusal: RoomRefusal): void;
  /** The actions of every tick before it is stepped: enough to play a match again from its start. */
  stepped?(actions: readonly MatchAction<Game>[]): void;
}
