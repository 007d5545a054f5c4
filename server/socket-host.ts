import { randomBytes } from 'node:crypto';
import type { Server as HttpServer, IncomingMessage } from 'node:http';
import type { Socket as NetSocket } from 'node:net';
import type { Logger } from 'pino';
import { RateLimiterMemory, RateLimiterRes } from 'rate-limiter-flexible';
import { Server, type Socket } from 'socket.io';
import {
  clientMessageFrom,
  type Farewell,
  longestMessage,
  protocolVersion,
  type RoomMessage,
} from '../src/core/protocol/messages';
import { messageEvent, poseEvent, relayParser } from '../src/core/protocol/small-frames';
import { createRoom, type Room, type RoomCensus } from '../src/core/room/room';
import { type Budget, createBudget } from './budget';
import type { RelayConfiguration } from './relay-configuration';
import type { RelayCensus, RelayMetrics } from './relay-metrics';
import type { RoomPass, RoomTokens } from './room-tokens';

/** Where the relay is found on its server. */
export const relayPath = '/relay';

export interface SocketHostOptions {
  readonly configuration: RelayConfiguration;
  readonly tokens: RoomTokens;
  readonly log: Logger;
  readonly metrics: RelayMetrics;
  /** Seconds, monotonic: the clock of all rooms. */
  readonly now: () => number;
}

/** A room as others may know it. */
export interface RoomListing extends Omit<RoomCensus, 'empty'> {
  readonly room: string;
  readonly kind: Room['options']['kind'];
  readonly phase: 'open' | 'ready' | 'running' | 'over';
}

/** Sockets on one side, rooms on the other. */
export interface SocketHost {
  readonly io: Server;
  readonly rooms: readonly RoomListing[];
  readonly census: RelayCensus;
  /** The room of this name, for tests and for whoever runs the server; null: there is none. */
  room(name: string): Room | null;
  /** Ends a room for everybody in it; false: there is none. */
  end(name: string): boolean;
  /** Tells everybody that the server stops, and ends all connections. */
  close(): Promise<void>;
}

/** Who has not joined a room this long after connecting is disconnected [s]. */
const joinPatience = 5;
const badMessagesAllowed = 3;
/** A connection that could take no frame for this long [s], or has this many packets waiting, is too slow. */
const slowSeconds = 5;
const mostWaiting = 256;
/** More than this many messages of any kind in a second is an attack. */
const floodPerSecond = 300;
/** What a budget refused may be this much in a row before it counts as an attack. */
const mostOverdrawn = 60;
/** An empty room is kept this long [s]. */
const emptyRoomSeconds = 5;
/** After a farewell the connection is torn down within this [ms], whether or not the other side reads. */
const farewellMs = 1000;

interface Guest {
  readonly id: string;
  readonly socket: Socket;
  readonly pass: RoomPass;
  readonly connectedAt: number;
  readonly poses: Budget;
  readonly events: Budget;
  readonly flood: Budget;
  joined: boolean;
  badMessages: number;
  /** The last time that the connection could take a frame [s]. */
  writableAt: number;
  ended: boolean;
}

interface HostedRoom {
  readonly room: Room;
  /** Connections that have joined. */
  readonly guests: Map<string, Guest>;
  emptySince: number | null;
}

/** The bytes as one unmasked binary WebSocket frame, so that it is made once for a whole room. */
function webSocketFrame(bytes: Uint8Array): Buffer {
  const short = bytes.length < 126;
  const frame = Buffer.allocUnsafe((short ? 2 : 4) + bytes.length);
  frame[0] = 0x82;
  frame[1] = short ? bytes.length : 126;
  if (!short) frame.writeUInt16BE(bytes.length, 2);
  frame.set(bytes, short ? 2 : 4);
  return frame;
}

/** Packets that wait for the connection to take them. */
const packetsWaiting = (conn: Socket['conn']): number =>
  // reason: private in the types, yet the only count there is: the socket's own buffer shows 16 KiB at most.
  (conn as unknown as { readonly writeBuffer: readonly unknown[] }).writeBuffer.length;

/** Somebody who would join with another version of the protocol: a page from before an update, left open. */
const isOtherVersion = (value: unknown): boolean => {
  const { type, version } = (value ?? {}) as { type?: unknown; version?: unknown };
  return type === 'join' && typeof version === 'number' && version !== protocolVersion;
};

/** Whether a page may connect from where it says it comes from. Programs that are no browsers name no origin; they need a token all the same. */
export function originAllowed({ headers }: Pick<IncomingMessage, 'headers'>, allowed: readonly string[]): boolean {
  const { origin, host } = headers;
  if (origin === undefined) return true;
  if (!URL.canParse(origin)) return false;
  return allowed.length > 0 ? allowed.includes(new URL(origin).origin) : new URL(origin).host === host;
}

/** Serves rooms on the server's upgrade requests to `relayPath`. */
export function createSocketHost(server: HttpServer, options: SocketHostOptions): SocketHost {
  const { configuration, tokens, log, metrics, now } = options;
  const { counts } = metrics;
  const epoch = randomBytes(6).toString('base64url');
  const rooms = new Map<string, HostedRoom>();
  const guests = new Set<Guest>();
  const connects = new RateLimiterMemory({ points: 30, duration: 60 });
  let roomsMade = 0;

  const io = new Server(server, {
    path: relayPath,
    transports: ['websocket'],
    allowUpgrades: false,
    perMessageDeflate: false,
    httpCompression: false,
    serveClient: false,
    maxHttpBufferSize: longestMessage,
    connectTimeout: joinPatience * 1000,
    // A page that hangs, and a reader that stalls behind full buffers, is found out within seven seconds.
    pingInterval: 3000,
    pingTimeout: 4000,
    parser: relayParser,
    allowRequest(request, answer) {
      const allowed = originAllowed(request, configuration.origins);
      if (!allowed) {
        metrics.kicked('origin');
        log.warn({ origin: request.headers.origin }, 'origin refused');
      }
      answer(null, allowed);
    },
  });

  /** Ends the connection however little the other side reads. */
  function hangUp(socket: Socket): void {
    socket.disconnect(true);
    const raw: NetSocket | undefined = socket.conn.request?.socket;
    setTimeout(() => raw?.destroy(), farewellMs).unref();
  }

  function dismiss(guest: Guest, reason: Farewell): void {
    if (guest.ended) return;
    guest.ended = true;
    tell(guest, { type: 'farewell', reason });
    hangUp(guest.socket);
  }

  function kick(guest: Guest, reason: 'misbehaved' | 'slow', because: string): void {
    if (guest.ended) return;
    metrics.kicked(because);
    log.warn({ room: guest.pass.room, client: guest.id, because }, 'kicked');
    rooms.get(guest.pass.room)?.room.disconnect(guest.id, now());
    rooms.get(guest.pass.room)?.guests.delete(guest.id);
    dismiss(guest, reason);
  }

  const tell = (guest: Guest, message: RoomMessage): void => {
    guest.socket.emit(messageEvent, message);
  };

  /** To everybody who has a free connection; who has not misses this one. */
  function sendFrame(to: Iterable<Guest>, bytes: Uint8Array): void {
    const payload = Buffer.from(bytes.buffer, bytes.byteOffset, bytes.length);
    const sending = { compress: false, wsPreEncodedFrame: [webSocketFrame(bytes)] };
    const time = now();
    for (const guest of to) {
      if (guest.ended) continue;
      const { conn } = guest.socket;
      if (conn.transport.writable) {
        guest.writableAt = time;
        conn.write(payload, sending);
        counts.framesOut += 1;
        counts.bytesOut += bytes.length;
      } else {
        counts.framesDropped += 1;
      }
    }
  }

  /** The first to come decides how long a round is, within what the server signed. */
  function makeRoom({ room: id, kind, terms }: RoomPass): HostedRoom {
    const { pausable = false, ...ball } = terms;
    roomsMade += 1;
    const joined = new Map<string, Guest>();
    const room = createRoom(
      {
        id,
        kind,
        epoch: `${epoch}${roomsMade}`,
        seats: configuration.openSeats,
        ball: { seconds: configuration.ballSeconds, ...ball },
        pausable,
      },
      {
        send(to, message) {
          const guest = joined.get(to);
          if (guest) tell(guest, message);
        },
        broadcast: (message) => {
          io.to(id).emit(messageEvent, message);
        },
        frame: (bytes) => sendFrame(joined.values(), bytes),
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
    const hosted = { room, guests: joined, emptySince: null };
    rooms.set(id, hosted);
    log.info({ room: id, kind, terms }, 'room opened');
    return hosted;
  }

  io.use(async (socket, next) => {
    const { token } = socket.handshake.auth as { token?: unknown };
    const pass = typeof token === 'string' ? await tokens.verify(token) : null;
    if (!pass) {
      metrics.kicked('token');
      next(new Error('refused'));
      return;
    }
    try {
      await connects.consume(pass.identity);
    } catch (error) {
      if (!(error instanceof RateLimiterRes)) throw error;
      metrics.kicked('connects');
      next(new Error('too-often'));
      return;
    }
    socket.data.pass = pass;
    next();
  });

  io.on('connection', (socket) => {
    const time = now();
    const guest: Guest = {
      id: socket.id,
      socket,
      pass: socket.data.pass,
      connectedAt: time,
      poses: createBudget(configuration.posesPerSecond),
      events: createBudget(configuration.eventsPerSecond, 2 * configuration.eventsPerSecond),
      flood: createBudget(floodPerSecond),
      joined: false,
      badMessages: 0,
      writableAt: time,
      ended: false,
    };
    guests.add(guest);

    const bad = (why: string): void => {
      guest.badMessages += 1;
      log.info({ room: guest.pass.room, client: guest.id, why }, 'bad message');
      if (guest.badMessages >= badMessagesAllowed) kick(guest, 'misbehaved', 'bad-messages');
    };
    /** Whether this message is still within what a client may send. */
    const within = (budget: Budget): boolean => {
      const at = now();
      if (!guest.flood.spend(at)) {
        kick(guest, 'misbehaved', 'flood');
        return false;
      }
      if (budget.spend(at)) return true;
      if (budget.overdrawn > mostOverdrawn) kick(guest, 'misbehaved', 'budget');
      return false;
    };

    socket.on(poseEvent, (bytes: unknown) => {
      counts.posesIn += 1;
      if (guest.ended) return;
      if (!(bytes instanceof Uint8Array)) {
        bad('pose');
        return;
      }
      counts.bytesIn += bytes.length;
      if (!within(guest.poses)) {
        counts.posesIgnored += 1;
        return;
      }
      const result = rooms.get(guest.pass.room)?.room.receivePose(guest.id, bytes, now());
      if (result === 'bad') bad('pose');
      if (result !== 'taken') counts.posesIgnored += 1;
    });

    socket.on(messageEvent, (value: unknown) => {
      counts.messagesIn += 1;
      if (guest.ended || !within(guest.events)) return;
      const message = clientMessageFrom(value);
      if (!message) {
        if (isOtherVersion(value)) {
          log.info({ room: guest.pass.room, client: guest.id }, 'page of another version');
          dismiss(guest, 'old-page');
        } else bad('message');
        return;
      }
      const at = now();
      if (message.type !== 'join') {
        rooms.get(guest.pass.room)?.room.receive(guest.id, message, at);
        return;
      }
      if (guest.joined) {
        bad('second join');
        return;
      }
      const existing = rooms.get(guest.pass.room);
      if (!existing && rooms.size >= configuration.mostRooms) {
        kick(guest, 'misbehaved', 'rooms-full');
        return;
      }
      const hosted = existing ?? makeRoom(guest.pass);
      guest.joined = true;
      hosted.emptySince = null;
      hosted.guests.set(guest.id, guest);
      void socket.join(guest.pass.room);
      const { type: _type, version: _version, ...joining } = message;
      hosted.room.join(guest.id, guest.pass.identity, joining, at);
    });

    socket.onAny((event: string) => {
      if (event !== poseEvent && event !== messageEvent) kick(guest, 'misbehaved', 'unknown-event');
    });

    socket.on('disconnect', (reason) => {
      guest.ended = true;
      guests.delete(guest);
      const hosted = rooms.get(guest.pass.room);
      hosted?.guests.delete(guest.id);
      hosted?.room.disconnect(guest.id, now());
      log.debug({ room: guest.pass.room, client: guest.id, reason }, 'disconnected');
    });
  });

  function sweep(time: number): void {
    for (const guest of guests) {
      if (guest.ended) continue;
      const { conn } = guest.socket;
      if (conn.transport.writable) guest.writableAt = time;
      if (time - guest.writableAt > slowSeconds || packetsWaiting(conn) > mostWaiting) {
        kick(guest, 'slow', 'slow');
      } else if (!guest.joined && time - guest.connectedAt > joinPatience) {
        kick(guest, 'misbehaved', 'no-join');
      }
    }
    for (const [id, hosted] of rooms) {
      if (!hosted.room.census.empty) {
        hosted.emptySince = null;
        continue;
      }
      hosted.emptySince ??= time;
      if (time - hosted.emptySince < emptyRoomSeconds) continue;
      rooms.delete(id);
      log.info({ room: id }, 'room closed');
    }
  }

  const period = 1 / configuration.tickHz;
  let next = now() + period;
  let swept = now();
  let closed = false;
  // What has arrived meanwhile is read first: a timer fires before that, and poses would wait for the tick after.
  const soon = (): NodeJS.Immediate => setImmediate(tick);
  let timer = setTimeout(soon, period * 1000);
  function tick(): void {
    if (closed) return;
    const started = now();
    for (const { room } of rooms.values()) room.tick(now());
    if (started - swept > 1) {
      swept = started;
      sweep(started);
    }
    const ended = now();
    metrics.tick.observe(ended - started);
    // Whole milliseconds are all a timer knows: what it was late is made up for, what was missed altogether is not.
    next = Math.max(next + period, ended);
    timer = setTimeout(soon, Math.max(0, Math.floor((next - ended) * 1000)));
  }

  return {
    io,
    get rooms() {
      return [...rooms].map(([room, { room: hosted }]): RoomListing => {
        const { empty: _empty, ...census } = hosted.census;
        return { room, kind: hosted.options.kind, phase: hosted.match?.phase ?? 'open', ...census };
      });
    },
    get census() {
      const all = [...rooms.values()].map(({ room }) => room.census);
      const sum = (key: 'players' | 'bots' | 'spectators') => all.reduce((total, census) => total + census[key], 0);
      return {
        rooms: rooms.size,
        players: sum('players'),
        bots: sum('bots'),
        spectators: sum('spectators'),
        sockets: guests.size,
      };
    },
    room: (name) => rooms.get(name)?.room ?? null,
    end(name) {
      const hosted = rooms.get(name);
      if (!hosted) return false;
      rooms.delete(name);
      for (const guest of hosted.guests.values()) dismiss(guest, 'closed');
      return true;
    },
    async close() {
      closed = true;
      clearTimeout(timer);
      for (const guest of guests) dismiss(guest, 'stopping');
      rooms.clear();
      await new Promise((resolve) => setTimeout(resolve, 50));
      io.disconnectSockets(true);
      io.engine.close();
    },
  };
}
