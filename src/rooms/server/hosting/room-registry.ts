import { randomBytes } from 'node:crypto';
import type { Logger } from 'pino';
import type { RoomMessage } from '../../protocol/messages';
import type { HostedGame } from '../../room/match-policy';
import { Room, type RoomCensus } from '../../room/room';
import type { RoomPass } from '../access/room-tokens';
import type { RelayConfiguration } from '../settings/relay-configuration';
import type { HostCensus, RelayMetrics } from '../settings/relay-metrics';
import { type Client, disconnect, send, sendPoses } from './client';
import { PoseSchedule, type PoseSender } from './pose-schedule';
import type { RoomKinds } from './room-kinds';
import { createTicker } from './ticker';

/** The public description of a room. Rooms with assigned places are not listed. */
export interface RoomListing extends Omit<RoomCensus, 'empty'> {
  readonly room: string;
  readonly kind: string;
  readonly phase: HostedGame['state']['phase'];
}

export interface RegisteredRoom extends PoseSender {
  readonly room: Room<HostedGame>;
  /** Whether the lobby lists the room. */
  readonly listed: boolean;
  /** Clients that have joined, by id. */
  readonly clients: Map<string, Client>;
  emptySince: number | null;
  /** Time of the next tick [s]. */
  tickAt: number;
}

/** The rooms of this process. */
export interface RoomRegistry {
  readonly listings: readonly RoomListing[];
  readonly census: HostCensus;
  get(name: string): RegisteredRoom | undefined;
  /**
   * Returns the room of this name, and ticks it until it is idle again; called when a client sends a message or
   * disconnects.
   */
  wake(name: string): RegisteredRoom | undefined;
  /** Schedules the sending of a room's poses, and ticks it until it is idle again. */
  sendPoses(hosted: RegisteredRoom): void;
  /**
   * Returns the room of a pass, and creates it if needed; null: the server has too many rooms, or does not have the
   * game.
   */
  getOrCreate(pass: RoomPass): RegisteredRoom | null;
  /** Closes rooms that have been empty for `emptyRoomSeconds`; called periodically. `now`: seconds. */
  sweep(now: number): void;
  /** Closes a room and disconnects its clients; returns false if there is none. */
  end(name: string): boolean;
  /** Removes all rooms and stops ticking. */
  clear(): void;
}

export interface RoomRegistryOptions {
  readonly configuration: RelayConfiguration;
  readonly kinds: RoomKinds;
  readonly log: Logger;
  readonly metrics: RelayMetrics;
  /** Seconds, monotonic. */
  readonly now: () => number;
  /** Sends a message to all clients that have joined a room. */
  readonly broadcast: (name: string, message: RoomMessage<HostedGame>) => void;
}

/** An empty room is closed after this time [s]. */
const emptyRoomSeconds = 5;

/** Returns a function that creates the room of a pass; the pass of the first person decides its terms. */
function roomFactory({ configuration, kinds, log, metrics, broadcast }: RoomRegistryOptions) {
  const epoch = randomBytes(6).toString('base64url');
  let made = 0;
  return ({ room: id, kind, terms, assigned }: RoomPass): RegisteredRoom | null => {
    const policy = kinds.get(kind)?.(terms, assigned !== null);
    if (!policy) return null;
    made += 1;
    const joined = new Map<string, Client>();
    const room = new Room(
      policy,
      {
        ...{ id, epoch: `${epoch}${made}`, pausable: terms.pausable ?? false, assigned: assigned !== null },
        // Studies do not ask for consent to voices.
        voices: configuration.voices !== null && assigned === null,
      },
      {
        send(to, message) {
          const client = joined.get(to);
          if (client) send(client, message);
        },
        broadcast: (message) => broadcast(id, message),
        sendPoses: (poses) => sendPoses(joined.values(), poses, metrics.counts),
        disconnect(id, reason) {
          const client = joined.get(id);
          joined.delete(id);
          if (client) disconnect(client, reason);
        },
        refused({ client, seat, what, reason }) {
          metrics.refused(what, reason);
          log.info({ room: id, client, seat, what, reason }, 'refused');
        },
      },
    );
    log.info({ room: id, kind, terms }, 'room opened');
    return { room, listed: assigned === null, clients: joined, sentAt: 0, emptySince: null, tickAt: 0 };
  };
}

/** Ticks the rooms that are not idle. */
class ActiveRooms {
  readonly #rooms = new Set<RegisteredRoom>();
  readonly #options: RoomRegistryOptions;
  readonly #ticker: ReturnType<typeof createTicker>;

  constructor(options: RoomRegistryOptions) {
    this.#options = options;
    this.#ticker = createTicker(options.configuration.tickHz, options.now, () => this.#tick());
  }

  add(hosted: RegisteredRoom): void {
    this.#rooms.add(hosted);
    this.#ticker.wake();
  }

  /** Adds a room and ticks it with the next tick. */
  wake(hosted: RegisteredRoom): RegisteredRoom {
    hosted.tickAt = 0;
    this.add(hosted);
    return hosted;
  }

  delete(hosted: RegisteredRoom): void {
    this.#rooms.delete(hosted);
  }

  stop(): void {
    this.#ticker.stop();
    this.#rooms.clear();
  }

  /** Ticks the rooms that are due. Returns whether any is still active. */
  #tick(): boolean {
    const { configuration, metrics, now } = this.#options;
    const started = now();
    const latest = started + 0.5 / configuration.tickHz;
    for (const hosted of this.#rooms) {
      if (hosted.tickAt > latest) continue;
      hosted.room.tick(now());
      hosted.tickAt = started + hosted.room.tickPeriod;
      if (hosted.room.isIdle) this.#rooms.delete(hosted);
    }
    metrics.tick.observe(now() - started);
    return this.#rooms.size > 0;
  }
}

export function createRoomRegistry(options: RoomRegistryOptions): RoomRegistry {
  const { configuration, log, now } = options;
  const rooms = new Map<string, RegisteredRoom>();
  const active = new ActiveRooms(options);
  const create = roomFactory(options);
  const schedule = new PoseSchedule(now);

  function remove(name: string, hosted: RegisteredRoom): void {
    rooms.delete(name);
    active.delete(hosted);
  }
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
    wake(name) {
      const hosted = rooms.get(name);
      return hosted && active.wake(hosted);
    },
    sendPoses(hosted) {
      schedule.add(hosted);
      active.add(hosted);
    },
    getOrCreate(pass) {
      const existing = rooms.get(pass.room);
      if (existing) return active.wake(existing);
      if (rooms.size >= configuration.mostRooms) return null;
      const hosted = create(pass);
      if (!hosted) return null;
      rooms.set(pass.room, hosted);
      return active.wake(hosted);
    },
    sweep(now) {
      for (const [id, hosted] of rooms) {
        if (!hosted.room.census.empty) {
          hosted.emptySince = null;
          continue;
        }
        hosted.emptySince ??= now;
        if (now - hosted.emptySince < emptyRoomSeconds) continue;
        remove(id, hosted);
        log.info({ room: id }, 'room closed');
      }
    },
    end(name) {
      const hosted = rooms.get(name);
      if (!hosted) return false;
      remove(name, hosted);
      for (const client of hosted.clients.values()) disconnect(client, 'closed');
      return true;
    },
    clear() {
      active.stop();
      schedule.stop();
      rooms.clear();
    },
  };
}
