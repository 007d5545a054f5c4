import type { Logger } from 'pino';
import { RateLimiterMemory, RateLimiterRes } from 'rate-limiter-flexible';
import type { Server, Socket } from 'socket.io';
import { messageEvent } from '../protocol/small-frames';
import type { HostedGame } from '../room/match-policy';
import type { Room } from '../room/room';
import { createGuest, dismiss, type Guest } from './guest';
import { GuestMessages } from './guest-messages';
import { createHostedRooms, type RoomListing } from './hosted-rooms';
import type { RelayConfiguration } from './relay-configuration';
import type { HostCensus, RelayMetrics } from './relay-metrics';
import type { RelayTransport } from './relay-transport';
import type { RoomKinds } from './room-kinds';
import type { RoomTokens } from './room-tokens';

export interface SocketHostOptions {
  readonly configuration: RelayConfiguration;
  /** The games that its rooms may be for. */
  readonly kinds: RoomKinds;
  readonly tokens: RoomTokens;
  readonly log: Logger;
  readonly metrics: RelayMetrics;
  /** Seconds, monotonic: the clock of all rooms. */
  readonly now: () => number;
}

/** Sockets on one side, rooms on the other. */
export interface SocketHost {
  readonly io: Server;
  readonly rooms: readonly RoomListing[];
  readonly census: HostCensus;
  /** The room of this name, for tests and for the server's owner; null: there is none. */
  room(name: string): Room<HostedGame> | null;
  /** Ends a room for all in it; false: there is none. */
  end(name: string): boolean;
  /** Tells all guests that the server stops, and ends all connections. */
  close(): Promise<void>;
}

/** A guest who has not joined a room this long after connecting is disconnected [s]. */
const joinPatience = 5;
/** Guests who join nothing, and rooms that are empty, are looked for this often [ms]. */
const sweepMs = 1000;
/** Connections a minute that one person may make. */
const connectsPerMinute = 30;

/** Lets sockets with a pass in, each person so often a minute. */
function createGate({ kinds, tokens, metrics, log }: SocketHostOptions): Parameters<Server['use']>[0] {
  const connects = new RateLimiterMemory({ points: connectsPerMinute, duration: 60 });
  async function refusalOf(socket: Socket): Promise<'refused' | 'too-often' | null> {
    const { token } = socket.handshake.auth as { token?: unknown };
    const pass = typeof token === 'string' ? await tokens.verify(token) : null;
    if (!pass || !kinds.has(pass.kind)) {
      metrics.kicked('token');
      return 'refused';
    }
    try {
      await connects.consume(pass.identity);
    } catch (error) {
      if (!(error instanceof RateLimiterRes)) throw error;
      metrics.kicked('connects');
      return 'too-often';
    }
    socket.data.pass = pass;
    return null;
  }
  return (socket, next) => {
    refusalOf(socket).then(
      (refusal) => (refusal ? next(new Error(refusal)) : next()),
      (error: unknown) => {
        log.error({ error: String(error) }, 'pass not read');
        next(new Error('refused'));
      },
    );
  };
}

/** Serves rooms on the transport's WebSockets. */
export function createSocketHost({ io, listen, close }: RelayTransport, options: SocketHostOptions): SocketHost {
  const { configuration, kinds, log, metrics, now } = options;
  const guests = new Set<Guest>();
  const rooms = createHostedRooms({
    configuration,
    kinds,
    log,
    metrics,
    now,
    broadcast: (name, message) => {
      io.to(name).emit(messageEvent, message);
    },
  });
  const messages = new GuestMessages({ rooms, log, metrics, now });

  io.use(createGate(options));
  io.on('connection', (socket) => {
    const guest = createGuest(socket, configuration, now());
    guests.add(guest);
    listen(socket, {
      onPose: (bytes) => messages.onPose(guest, bytes),
      onFault: (fault) => messages.kick(guest, fault === 'slow' ? 'slow' : 'misbehaved', fault),
    });
    socket.on(messageEvent, (value: unknown) => messages.onMessage(guest, value));
    socket.onAny((event: string) => {
      if (event !== messageEvent) messages.kick(guest, 'misbehaved', 'unknown-event');
    });
    socket.on('disconnect', (reason) => {
      guest.ended = true;
      guests.delete(guest);
      messages.onEnd(guest);
      log.debug({ room: guest.pass.room, client: guest.id, reason }, 'disconnected');
    });
  });

  const sweeping = setInterval(() => {
    const at = now();
    for (const guest of guests) {
      const waitsToJoin = !guest.ended && !guest.joined;
      if (waitsToJoin && at - guest.connectedAt > joinPatience) messages.kick(guest, 'misbehaved', 'no-join');
    }
    rooms.sweep(at);
  }, sweepMs);

  return {
    io,
    get rooms() {
      return rooms.listings;
    },
    get census() {
      return rooms.census;
    },
    room: (name) => rooms.get(name)?.room ?? null,
    end: rooms.end,
    async close() {
      clearInterval(sweeping);
      for (const guest of guests) dismiss(guest, 'stopping');
      rooms.clear();
      await new Promise((resolve) => setTimeout(resolve, 50));
      close();
    },
  };
}
