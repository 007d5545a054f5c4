import type { Logger } from 'pino';
import { RateLimiterMemory, RateLimiterRes } from 'rate-limiter-flexible';
import type { Server, Socket } from 'socket.io';
import { messageEvent } from '../../protocol/socket-parsers';
import type { HostedGame } from '../../room/match-policy';
import type { Room } from '../../room/room';
import type { RoomTokens } from '../access/room-tokens';
import type { RelayConfiguration } from '../settings/relay-configuration';
import type { HostCensus, RelayMetrics } from '../settings/relay-metrics';
import type { RelayTransport } from '../sockets/relay-transport';
import { type Client, createClient, disconnect } from './client';
import { MessageHandler } from './message-handler';
import type { RoomKinds } from './room-kinds';
import { type RoomListing, RoomRegistry } from './room-registry';

export interface SocketHostOptions {
  readonly configuration: RelayConfiguration;
  /** The games of the server. */
  readonly kinds: RoomKinds;
  readonly tokens: RoomTokens;
  readonly log: Logger;
  readonly metrics: RelayMetrics;
  /** Seconds, monotonic: the clock of all rooms. */
  readonly now: () => number;
}

/** A client that has not joined a room this long after connecting is disconnected [s]. */
const joinTimeout = 5;
/** Interval of the check for clients that have not joined and for empty rooms [ms]. */
const sweepMs = 1000;
/** The most connections of one person per minute. */
const connectsPerMinute = 30;

/** Returns middleware that accepts sockets with a valid pass, and limits the connections of each person. */
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
        log.error({ error: String(error) }, 'the pass could not be verified');
        next(new Error('refused'));
      },
    );
  };
}

export type SocketHost = ReturnType<typeof createSocketHost>;

/** Connects the sockets of a transport to the rooms of this process. */
export function createSocketHost({ io, listen, close }: RelayTransport, options: SocketHostOptions) {
  const { configuration, kinds, log, metrics, now } = options;
  const clients = new Set<Client>();
  const rooms = new RoomRegistry({
    configuration,
    kinds,
    log,
    metrics,
    now,
    broadcast: (name, message) => {
      io.to(name).emit(messageEvent, message);
    },
  });
  const messages = new MessageHandler({ rooms, log, metrics, now });

  io.use(createGate(options));
  io.on('connection', (socket) => {
    const client = createClient(socket, configuration, now());
    clients.add(client);
    listen(socket, {
      onPose: (bytes) => messages.onPose(client, bytes),
      onFault: (fault) => messages.kick(client, fault === 'slow' ? 'slow' : 'misbehaved', fault),
    });
    socket.on(messageEvent, (value: unknown) => messages.onMessage(client, value));
    socket.onAny((event: string) => {
      if (event !== messageEvent) messages.kick(client, 'misbehaved', 'unknown-event');
    });
    socket.on('disconnect', (reason) => {
      client.ended = true;
      clients.delete(client);
      messages.onDisconnect(client);
      log.debug({ room: client.pass.room, client: client.id, reason }, 'disconnected');
    });
  });

  const sweeping = setInterval(() => {
    const at = now();
    for (const client of clients) {
      const waitsToJoin = !client.ended && !client.joined;
      if (waitsToJoin && at - client.connectedAt > joinTimeout) messages.kick(client, 'misbehaved', 'no-join');
    }
    rooms.sweep(at);
  }, sweepMs);

  return {
    io,
    get rooms(): readonly RoomListing[] {
      return rooms.listings;
    },
    get census(): HostCensus {
      return rooms.census;
    },
    /** Returns the room of this name; null: there is none. */
    room: (name: string): Room<HostedGame> | null => rooms.get(name)?.room ?? null,
    /** Closes a room and disconnects its clients; returns false if there is none. */
    end: (name: string): boolean => rooms.end(name),
    /** Disconnects all clients with the reason 'stopping'. */
    async close(): Promise<void> {
      clearInterval(sweeping);
      for (const client of clients) disconnect(client, 'stopping');
      rooms.clear();
      await new Promise((resolve) => setTimeout(resolve, 50));
      close();
    },
  };
}
