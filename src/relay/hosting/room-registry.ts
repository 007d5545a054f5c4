import { randomBytes } from 'node:crypto';
import type { Server } from 'socket.io';
import { guarded } from 'threepoint-http';
import { type FreshPose, messageEvent, Room, type RoomCensus } from 'threepoint-rooms/host';
import type { HostedGame } from 'threepoint-rooms/room';
import type { PassClaims } from '../access/room-tokens';
import type { RelayContext } from '../relay-context';
import type { HostCensus } from '../settings/relay-metrics';
import { type Client, disconnect, send, sendPoses } from './client';
import { PoseSchedule, type ScheduledRoom } from './pose-schedule';
import { createTicker, type Ticker } from './ticker';

/** The public description of a room. Rooms with assigned seats are not listed. */
export interface RoomListing extends Omit<RoomCensus, 'empty'> {
  readonly room: string;
  readonly kind: string;
  readonly phase: HostedGame['state']['phase'];
  /** Whether its first person has set terms; matchmaking leads to other rooms. */
  readonly ownTerms: boolean;
}

interface RegisteredRoom extends ScheduledRoom {
  readonly room: Room<HostedGame>;
  /** Whether the lobby lists the room. */
  readonly listed: boolean;
  readonly ownTerms: boolean;
  /** Clients that have joined, by id. */
  readonly clients: Map<string, Client>;
  emptySince: number | null;
  /** Time of the next tick [s]. */
  tickAt: number;
  /** Ticks the room; a room whose tick fails is closed. `now`: seconds. */
  tick(now: number): void;
}

/** An empty room is closed after this time [s]. */
const emptyRoomSeconds = 5;

/** The rooms of this process. Those that are not idle are ticked. */
export class RoomRegistry {
  readonly #context: RelayContext;
  readonly #io: Server;
  readonly #rooms = new Map<string, RegisteredRoom>();
  /** The rooms that are ticked. */
  readonly #active = new Set<RegisteredRoom>();
  readonly #ticker: Ticker;
  readonly #schedule: PoseSchedule;
  readonly #epoch = randomBytes(6).toString('base64url');
  #created = 0;

  /** `io` has a socket.io room of the same name for each room, with its clients. */
  constructor(context: RelayContext, io: Server) {
    this.#context = context;
    this.#io = io;
    this.#ticker = createTicker(context.configuration.tickHz, context.now, () => this.#tick());
    this.#schedule = new PoseSchedule(context.now);
  }

  get listings(): readonly RoomListing[] {
    return [...this.#rooms].flatMap(([room, { room: hosted, listed, ownTerms }]): readonly RoomListing[] => {
      if (!listed) return [];
      const { empty: _empty, ...census } = hosted.census;
      return [{ room, kind: hosted.kind, phase: hosted.match.phase, ownTerms, ...census }];
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
    if (hosted) {
      hosted.tickAt = 0;
      this.#activate(hosted);
    }
    return hosted;
  }

  /** Schedules the sending of a room's poses, and ticks it until it is idle again. */
  sendPoses(hosted: RegisteredRoom): void {
    this.#schedule.add(hosted);
    this.#activate(hosted);
  }

  /** Returns the room of a pass, and creates it if needed; null: the server has too many rooms. */
  getOrCreate(pass: PassClaims): RegisteredRoom | null {
    if (!this.#rooms.has(pass.room) && !this.#create(pass)) return null;
    return this.wake(pass.room) ?? null;
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
      this.#context.log.info({ room: id }, 'room closed');
    }
  }

  /** Closes a room and disconnects its clients; does nothing if there is none. */
  end(name: string): void {
    const hosted = this.#rooms.get(name);
    if (!hosted) return;
    this.#remove(name, hosted);
    for (const client of hosted.clients.values()) disconnect(client, 'closed');
  }

  /** Removes all rooms and stops ticking. */
  clear(): void {
    this.#ticker.stop();
    this.#schedule.stop();
    this.#active.clear();
    this.#rooms.clear();
  }

  /** Creates the room of a pass, whose terms it gets. Returns whether the server can open it. */
  #create({ room: id, kind, terms, assigned }: PassClaims): boolean {
    const { configuration, kinds, log, metrics } = this.#context;
    if (this.#rooms.size >= configuration.maxRooms) return false;
    const policy = kinds.get(kind)?.createPolicy(terms, assigned !== null);
    if (!policy) return false;
    this.#created += 1;
    const clients = new Map<string, Client>();
    const endRoom = (error: unknown): void => {
      log.error({ error: String(error), room: id, kind }, 'the room failed');
      this.end(id);
    };
    const room = new Room(
      policy,
      {
        ...{ id, epoch: `${this.#epoch}${this.#created}`, assigned: assigned !== null },
        // A clock that anyone may pause would hold up strangers.
        pausable: assigned !== null,
        // Studies do not ask for consent to voices.
        voices: configuration.voices !== null && assigned === null,
      },
      {
        send(to, message) {
          const client = clients.get(to);
          if (client) send(client, message);
        },
        broadcast: (message) => void this.#io.to(id).emit(messageEvent, message),
        sendPoses: guarded(
          (poses: readonly FreshPose[]) => sendPoses(clients.values(), poses, metrics.counts),
          endRoom,
        ),
        disconnect(id, reason) {
          const client = clients.get(id);
          clients.delete(id);
          if (client) disconnect(client, reason);
        },
        rejected({ client, seat, what, reason }) {
          metrics.refused(what, reason);
          log.info({ room: id, client, seat, what, reason }, 'refused');
        },
      },
    );
    log.info({ room: id, kind, terms }, 'room opened');
    const tick = guarded((now: number) => room.tick(now), endRoom);
    const listed = assigned === null;
    const ownTerms = Object.keys(terms).length > 0;
    this.#rooms.set(id, { room, listed, ownTerms, clients, sentAt: 0, emptySince: null, tickAt: 0, tick });
    return true;
  }

  #activate(hosted: RegisteredRoom): void {
    this.#active.add(hosted);
    this.#ticker.wake();
  }

  #remove(name: string, hosted: RegisteredRoom): void {
    this.#rooms.delete(name);
    this.#active.delete(hosted);
  }

  /** Ticks the rooms that are due. Returns whether any is still active. */
  #tick(): boolean {
    const { configuration, metrics, now } = this.#context;
    const started = now();
    const latest = started + 0.5 / configuration.tickHz;
    for (const hosted of this.#active) {
      if (hosted.tickAt > latest) continue;
      hosted.tick(now());
      hosted.tickAt = started + hosted.room.tickPeriod;
      if (hosted.room.isIdle) this.#active.delete(hosted);
    }
    metrics.tick.observe(now() - started);
    return this.#active.size > 0;
  }
}
