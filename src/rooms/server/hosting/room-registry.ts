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

/** A room as others may know it; those whose places are assigned are known to their people alone. */
export interface RoomListing extends Omit<RoomCensus, 'empty'> {
  readonly room: string;
  readonly kind: string;
  readonly phase: HostedGame['state']['phase'];
}

export interface RegisteredRoom extends PoseSender {
  readonly room: Room<HostedGame>;
  /** Whether the lobby may show it. */
  readonly listed: boolean;
  /** Connections that have joined. */
  readonly clients: Map<string, Client>;
  emptySince: number | null;
  /** When it is to be ticked next [s]. */
  tickAt: number;
}

/** The rooms of this process. */
export interface RoomRegistry {
  readonly listings: readonly RoomListing[];
  readonly census: HostCensus;
  get(name: string): RegisteredRoom | undefined;
  /** The room of this name, which has heard a message or lost a client: it is ticked soon, and until it is still again. */
  wake(name: string): RegisteredRoom | undefined;
  /** Sends the poses that have come into a room when it is time, and ticks it until it is still again. */
  sendPoses(hosted: RegisteredRoom): void;
  /** The room of this pass, made where there is none; null: there are too many, or its game is none of this server's. */
  getOrCreate(pass: RoomPass): RegisteredRoom | null;
  /** Closes rooms that have been empty for long; asked again and again, `now` in seconds. */
  sweep(now: number): void;
  /** Ends a room for all in it; false: there is none. */
  end(name: string): boolean;
  /** Forgets all rooms, and ticks no more. */
  clear(): void;
}

export interface RoomRegistryOptions {
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
function roomMaker({ configuration, kinds, log, metrics, broadcast }: RoomRegistryOptions) {
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
        // A study has no consent to voices to ask for.
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

/** Rooms where something has come of late, or goes on by itself: they are ticked until they are still. */
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

  /** As `add`, and it is ticked with the next tick. */
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

  /** Whether any is still awake. */
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
  const awake = new ActiveRooms(options);
  const make = roomMaker(options);
  const schedule = new PoseSchedule(now);

  function forget(name: string, hosted: RegisteredRoom): void {
    rooms.delete(name);
    awake.delete(hosted);
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
      return hosted && awake.wake(hosted);
    },
    sendPoses(hosted) {
      schedule.add(hosted);
      awake.add(hosted);
    },
    getOrCreate(pass) {
      const existing = rooms.get(pass.room);
      if (existing) return awake.wake(existing);
      if (rooms.size >= configuration.mostRooms) return null;
      const hosted = make(pass);
      if (!hosted) return null;
      rooms.set(pass.room, hosted);
      return awake.wake(hosted);
    },
    sweep(now) {
      for (const [id, hosted] of rooms) {
        if (!hosted.room.census.empty) {
          hosted.emptySince = null;
          continue;
        }
        hosted.emptySince ??= now;
        if (now - hosted.emptySince < emptyRoomSeconds) continue;
        forget(id, hosted);
        log.info({ room: id }, 'room closed');
      }
    },
    end(name) {
      const hosted = rooms.get(name);
      if (!hosted) return false;
      forget(name, hosted);
      for (const client of hosted.clients.values()) disconnect(client, 'closed');
      return true;
    },
    clear() {
      awake.stop();
      schedule.stop();
      rooms.clear();
    },
  };
}
