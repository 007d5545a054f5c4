import { randomBytes } from 'node:crypto';
import type { Logger } from 'pino';
import type { RoomMessage } from '../src/core/protocol/messages';
import type { HostedGame } from '../src/core/room/match-policy';
import { Room, type RoomCensus } from '../src/core/room/room';
import { dismiss, type Guest, sendFrame, tell } from './guest';
import type { RelayConfiguration } from './relay-configuration';
import type { HostCensus, RelayMetrics } from './relay-metrics';
import type { RoomKinds } from './room-kinds';
import type { RoomPass } from './room-tokens';

/** A room as others may know it; those whose places are assigned are known to their people alone. */
export interface RoomListing extends Omit<RoomCensus, 'empty'> {
  readonly room: string;
  readonly kind: string;
  readonly phase: HostedGame['state']['phase'];
}

export interface HostedRoom {
  readonly room: Room<HostedGame>;
  /** Whether the lobby may show it. */
  readonly listed: boolean;
  /** Connections that have joined. */
  readonly guests: Map<string, Guest>;
  emptySince: number | null;
}

/** The rooms of this process. */
export interface HostedRooms {
  readonly listings: readonly RoomListing[];
  readonly census: HostCensus;
  get(name: string): HostedRoom | undefined;
  /** The room of this pass, made where there is none; null: there are too many, or its game is none of this server's. */
  enter(pass: RoomPass): HostedRoom | null;
  tick(): void;
  /** Closes rooms that have been empty for long; asked again and again, `now` in seconds. */
  sweep(now: number): void;
  /** Ends a room for all in it; false: there is none. */
  end(name: string): boolean;
  clear(): void;
}

export interface HostedRoomsOptions {
  readonly configuration: RelayConfiguration;
  readonly kinds: RoomKinds;
  readonly log: Logger;
  readonly metrics: RelayMetrics;
  /** Seconds, monotonic. */
  readonly now: () => number;
  /** To all who have joined the room of this name. */
  readonly broadcast: (name: string, message: RoomMessage<HostedGame>) => void;
}

/** An empty room is kept this long [s]. */
const emptyRoomSeconds = 5;

/** Makes rooms: the first to come decides how long a round is, within what the server signed. */
function roomMaker({ kinds, log, metrics, now, broadcast }: HostedRoomsOptions) {
  const epoch = randomBytes(6).toString('base64url');
  let made = 0;
  return ({ room: id, kind, terms, assigned }: RoomPass): HostedRoom | null => {
    const policy = kinds.get(kind)?.(terms);
    if (!policy) return null;
    made += 1;
    const joined = new Map<string, Guest>();
    const room = new Room(
      policy,
      { id, epoch: `${epoch}${made}`, pausable: terms.pausable ?? false, assigned: assigned !== null },
      {
        send(to, message) {
          const guest = joined.get(to);
          if (guest) tell(guest, message);
        },
        broadcast: (message) => broadcast(id, message),
        frame: (bytes) => sendFrame(joined.values(), bytes, now(), metrics.counts),
        drop(client, reason) {
          const guest = joined.get(client);
          joined.delete(client);
          if (guest) dismiss(guest, reason);
        },
        refused({ client, seat, what, reason }) {
          metrics.refused(what, reason);
          log.info({ room: id, client, seat, what, reason }, 'refused');
        },
      },
    );
    log.info({ room: id, kind, terms }, 'room opened');
    return { room, listed: assigned === null, guests: joined, emptySince: null };
  };
}

export function createHostedRooms(options: HostedRoomsOptions): HostedRooms {
  const { configuration, log } = options;
  const rooms = new Map<string, HostedRoom>();
  const make = roomMaker(options);
  return {
    get listings() {
      return [...rooms].flatMap(([room, { room: hosted, listed }]): readonly RoomListing[] => {
        if (!listed) return [];
        const { empty: _empty, ...census } = hosted.census;
        return [{ room, kind: hosted.kind, phase: hosted.match.phase, ...census }];
      });
    },
    get census() {
      const all = [...rooms.values()].map(({ room }) => room.census);
      const sum = (key: 'players' | 'bots' | 'spectators') => all.reduce((total, census) => total + census[key], 0);
      return { rooms: rooms.size, players: sum('players'), bots: sum('bots'), spectators: sum('spectators') };
    },
    get: (name) => rooms.get(name),
    enter(pass) {
      const existing = rooms.get(pass.room);
      if (existing) return existing;
      if (rooms.size >= configuration.mostRooms) return null;
      const hosted = make(pass);
      if (!hosted) return null;
      rooms.set(pass.room, hosted);
      return hosted;
    },
    tick() {
      for (const { room } of rooms.values()) room.tick(options.now());
    },
    sweep(now) {
      for (const [id, hosted] of rooms) {
        if (!hosted.room.census.empty) {
          hosted.emptySince = null;
          continue;
        }
        hosted.emptySince ??= now;
        if (now - hosted.emptySince < emptyRoomSeconds) continue;
        rooms.delete(id);
        log.info({ room: id }, 'room closed');
      }
    },
    end(name) {
      const hosted = rooms.get(name);
      if (!hosted) return false;
      rooms.delete(name);
      for (const guest of hosted.guests.values()) dismiss(guest, 'closed');
      return true;
    },
    clear: () => rooms.clear(),
  };
}
