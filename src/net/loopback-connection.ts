import type { BallAction } from '../core/games/ball/ball-state';
import type { ClientMessage, RoomMessage } from '../core/protocol/messages';
import { type ClientId, createRoom, type Room, type RoomOptions, type RoomRefusal } from '../core/room/room';
import type { Connection, ConnectionStatus, Visitor } from './connection';
import { createRoomSession, type RoomSession } from './room-session';

/** A room in this page: for somebody alone, with bots if they like, and for tests. */
export interface LoopbackHost {
  readonly room: Room;
  /** `now`: this page's clock [s]. */
  connect(visitor: Visitor, now: number): Connection;
}

export interface LoopbackOptions extends Partial<Omit<RoomOptions, 'kind'>>, Pick<RoomOptions, 'kind'> {
  refused?(refusal: RoomRefusal): void;
  stepped?(actions: readonly BallAction[]): void;
}

interface Guest {
  readonly session: RoomSession;
  end(reason: ConnectionStatus['reason']): void;
}

/** The Room is the one of the server, and as it is this page's own it may be paused. It ticks when its first guest of a frame asks for news. */
export function createLoopbackHost({ refused, stepped, ...options }: LoopbackOptions): LoopbackHost {
  const guests = new Map<ClientId, Guest>();
  let now = 0;
  let ticked = Number.NEGATIVE_INFINITY;
  let made = 0;

  const room = createRoom(
    { id: 'here', epoch: 'here', pausable: true, ...options },
    {
      send: (to, message) => guests.get(to)?.session.hear(message, now),
      broadcast(message: RoomMessage) {
        for (const { session } of guests.values()) session.hear(message, now);
      },
      frame(bytes) {
        for (const { session } of guests.values()) session.hearFrame(bytes, now);
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
            if (here() && message.type !== 'join') room.receive(client, message, now);
          },
          pose(bytes) {
            if (here()) room.receivePose(client, bytes, now);
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
          if (here()) room.receive(client, { type: 'leave' }, now);
        },
      };
    },
  };
}
