import { randomBytes } from 'node:crypto';
import type { Logger } from 'pino';
import type { RoomMessage } from '../../protocol/messages';
import type { HostedGame } from '../../room/match-policy';
import { Room, type RoomCensus } from '../../room/room';
import type { PassClaims } from '../access/room-tokens';
import type { RelayConfiguration } from '../settings/relay-configuration';
import type { HostCensus, RelayMetrics } from '../settings/relay-metrics';
import { type Client, disconnect, send, sendPoses } from './client';
import { PoseSchedule, type ScheduledRoom } from './pose-schedule';
import type { RoomKinds } from './room-kinds';
import { createTicker } from './ticker';

/** The public description of a room. Rooms with assigned places are not listed. */
export interface RoomListing extends Omit<RoomCensus, 'empty'> {
  readonly room: string;
  readonly kind: string;
  readonly phase: HostedGame['state']['phase'];
}

export interface RegisteredRoom extends ScheduledRoom {
  readonly room: Room<HostedGame>;
  /** Whether the lobby lists the room. */
  readonly listed: boolean;
  /** Clients that have joined, by id. */
  readonly clients: Map<string, Client>;
  emptySince: number | null;
  /** Time of the next tick [s]. */
  tickAt: number;
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
  return ({ room: id, kind, terms, assigned }: PassClaims): RegisteredRoom | null => {
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

/** The rooms of this process. */
export class RoomRegistry {
  readonly #options: RoomRegistryOptions;
  readonly #rooms = new Map<string, RegisteredRoom>();
  readonly #active: ActiveRooms;
  readonly #create: (pass: PassClaims) => RegisteredRoom | null;
  readonly #schedule: PoseSchedule;

  constructor(options: RoomRegistryOptions) {
    this.#options = options;
    this.#active = new ActiveRooms(options);
    this.#create = roomFactory(options);
    this.#schedule = new PoseSchedule(options.now);
  }

  get listings(): readonly RoomListing[] {
    return [...this.#rooms].flatMap(([room, { room: hosted, listed }]): readonly RoomListing[] => {
      if (!listed) return [];
      const { empty: _empty, ...census } = hosted.census;
      return [{ room, kind: hosted.kind, phase: hosted.match.phase, ...census }];
    });
  }

  get census(): HostCensus {
    const all = [...this.#rooms.values()].map(({ room }) => room.census);
    const sum = (key: 'players' | 'bots' | 'spectators') => all.reduce((total, census) => total + census[key], 0);
    return { rooms: all.length, players: sum('players'), bots: sum('bots'), spectators: sum('spectators') };
  }

  get(name: string): RegisteredRoom | undefined {
    return this.#rooms.get(name);
  }

  /**
   * Returns the room of this name, and ticks it until it is idle again; called when a client sends a message or
   * disconnects.
   */
  wake(name: string): RegisteredRoom | undefined {
    const hosted = this.#rooms.get(name);
    return hosted && this.#active.wake(hosted);
  }

  /** Schedules the sending of a room's poses, and ticks it until it is idle again. */
  sendPoses(hosted: RegisteredRoom): void {
    this.#schedule.add(hosted);
    this.#active.add(hosted);
  }

  /**
   * Returns the room of a pass, and creates it if needed; null: the server has too many rooms, or does not have the
   * game.
   */
  getOrCreate(pass: PassClaims): RegisteredRoom | null {
    const existing = this.wake(pass.room);
    if (existing) return existing;
    if (this.#rooms.size >= this.#options.configuration.maxRooms) return null;
    const hosted = this.#create(pass);
    if (!hosted) return null;
    this.#rooms.set(pass.room, hosted);
    return this.#active.wake(hosted);
  }

  /** Closes rooms that have been empty for `emptyRoomSeconds`; called periodically. `now`: seconds. */
  sweep(now: number): void {
    for (const [id, hosted] of this.#rooms) {
      if (!hosted.room.census.empty) {
        hosted.emptySince = null;
        continue;
      }
      hosted.emptySince ??= now;
      if (now - hosted.emptySince < emptyRoomSeconds) continue;
      this.#remove(id, hosted);
      this.#options.log.info({ room: id }, 'room closed');
    }
  }

  /** Closes a room and disconnects its clients; returns false if there is none. */
  end(name: string): boolean {
    const hosted = this.#rooms.get(name);
    if (!hosted) return false;
    this.#remove(name, hosted);
    for (const client of hosted.clients.values()) disconnect(client, 'closed');
    return true;
  }

  /** Removes all rooms and stops ticking. */
  clear(): void {
    this.#active.stop();
    this.#schedule.stop();
    this.#rooms.clear();
  }

  #remove(name: string, hosted: RegisteredRoom): void {
    this.#rooms.delete(name);
    this.#active.delete(hosted);
  }
}
