import type { BallAction, BallOptions } from '../core/games/ball/ball-state';
import { type BallGame, BallPolicy } from '../core/match-policies/ball-policy';
import type { BallRoomMessage } from '../core/protocol/ball-messages';
import type { ClientMessage } from '../core/protocol/messages';
import { Room, type RoomOptions } from '../core/room/room';
import type { ClientId, RoomRefusal } from '../core/room/room-outlet';
import type { Connection, ConnectionStatus, Visitor } from './connection';
import { createRoomSession, type RoomSession } from './room-session';

/** A room of the ball game in this page: for a player alone, with bots if they like, and for tests. */
export interface LoopbackHost {
  readonly room: Room<BallGame>;
  /** `now`: this page's clock [s]. */
  connect(visitor: Visitor, now: number): Connection;
}

export interface LoopbackOptions extends Partial<RoomOptions> {
  readonly seed?: number;
  readonly ball?: Partial<BallOptions>;
  refused?(refusal: RoomRefusal): void;
  stepped?(actions: readonly BallAction[]): void;
}

interface Guest {
  readonly session: RoomSession;
  end(reason: ConnectionStatus['reason']): void;
}

/** The Room is the one of the server, and as it is this page's own it may be paused. It ticks when its first guest of a frame asks for news. */
export function createLoopbackHost({
  refused,
  stepped,
  seed = 0,
  ball,
  ...options
}: LoopbackOptions = {}): LoopbackHost {
  const guests = new Map<ClientId, Guest>();
  let now = 0;
  let ticked = Number.NEGATIVE_INFINITY;
  let made = 0;

  const room = new Room<BallGame>(
    new BallPolicy({ ...ball, seed }),
    { id: 'here', epoch: 'here', pausable: true, ...options },
    {
      send: (to, message) => guests.get(to)?.session.onMessage(message, now),
      broadcast(message: BallRoomMessage) {
        for (const { session } of guests.values()) session.onMessage(message, now);
      },
      frame(bytes) {
        for (const { session } of guests.values()) session.onFrame(bytes, now);
      },
      drop(client, reason) {
        guests.get(client)?.end(reason);
        guests.delete(client);
      },
      refused: (refusal) => refused?.(refusal),
      ...(stepped && { stepped }),
    },
  );

  return {
    room,
    connect(visitor, time) {
      now = Math.max(now, time);
      made += 1;
      const client = `guest ${made}`;
      let status: ConnectionStatus = { phase: 'joined', attempt: 0, retryIn: null, reason: null };
      const here = (): boolean => status.phase === 'joined';
      const session = createRoomSession(
        visitor,
        {
          message(message: ClientMessage) {
            if (here() && message.type !== 'join') room.onMessage(client, message, now);
          },
          pose(bytes) {
            if (here()) room.onPose(client, bytes, now);
          },
        },
        true,
      );
      guests.set(client, {
        session,
        end(reason) {
          status = { phase: 'ended', attempt: 0, retryIn: null, reason };
        },
      });
      room.join(client, client, session.joining(), now);
      return {
        ...session,
        get status() {
          return status;
        },
        get room() {
          return session.room;
        },
        update(frameTime) {
          now = Math.max(now, frameTime);
          if (now > ticked) {
            ticked = now;
            room.tick(now);
          }
          return session.update(now, here());
        },
        leave() {
          if (here()) room.onMessage(client, { type: 'leave' }, now);
        },
      };
    },
  };
}
