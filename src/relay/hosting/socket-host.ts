import { RateLimiterMemory } from 'rate-limiter-flexible';
import type { Server, Socket } from 'socket.io';
import { consumePoint, guarded } from 'threepoint-http';
import { messageEvent } from 'threepoint-rooms/host';
import { allowedTerms } from '../access/room-tokens';
import type { RelayContext } from '../relay-context';
import { closeConnection, type RelayTransport, type WireProblem } from '../sockets/relay-transport';
import { type Client, createClient, disconnect } from './client';
import { MessageHandler } from './message-handler';
import type { RoomRegistry } from './room-registry';

/** A client that has not joined a room this long after connecting is disconnected [s]. */
const joinTimeout = 5;
/** Interval of the check for clients that have not joined and for empty rooms [ms]. */
const sweepMs = 1000;
/** The most connections of one person per minute. */
const connectsPerMinute = 30;

/** Returns middleware that accepts sockets with a valid pass, and limits the connections of each person. */
function createGate({ kinds, tokens, metrics, log }: RelayContext): Parameters<Server['use']>[0] {
  const connects = new RateLimiterMemory({ points: connectsPerMinute, duration: 60 });
  async function rejectionOf(socket: Socket): Promise<'refused' | 'too-often' | null> {
    const { token } = socket.handshake.auth as { token?: unknown };
    const pass = typeof token === 'string' ? await tokens.verify(token) : null;
    const terms = pass && allowedTerms(kinds, pass);
    if (!terms) {
      metrics.kicked('token');
      return 'refused';
    }
    if ((await consumePoint(connects, pass.identity)) !== null) {
      metrics.kicked('connects');
      return 'too-often';
    }
    socket.data.pass = { ...pass, terms };
    return null;
  }
  return (socket, next) => {
    rejectionOf(socket).then(
      (rejection) => (rejection ? next(new Error(rejection)) : next()),
      (error: unknown) => {
        log.error({ error: String(error) }, 'the pass could not be verified');
        next(new Error('refused'));
      },
    );
  };
}

/**
 * Connects the sockets of a transport to the rooms of this process. Returns a function that disconnects all clients
 * with the reason 'stopping', and closes rooms and transport.
 */
export function hostSockets(
  { io, listen, sendFrame, close }: RelayTransport,
  rooms: RoomRegistry,
  context: RelayContext,
): () => Promise<void> {
  const { configuration, log, now, repeat } = context;
  const clients = new Set<Client>();
  const messages = new MessageHandler(rooms, context);

  io.use(createGate(context));
  io.on('connection', (socket) => {
    const client = createClient(socket, sendFrame, configuration, now());
    clients.add(client);
    const endClient = (error: unknown): void => {
      log.error({ error: String(error), room: client.pass.room, client: client.id }, 'a message failed');
      closeConnection(socket);
    };
    listen(socket, {
      onPose: (bytes) => messages.onPose(client, bytes),
      onError: guarded(
        (problem: WireProblem) => messages.kick(client, problem === 'slow' ? 'slow' : 'misbehaved', problem),
        endClient,
      ),
    });
    socket.on(
      messageEvent,
      guarded((value: unknown) => messages.onMessage(client, value), endClient),
    );
    socket.onAny(
      guarded((event: string) => {
        if (event !== messageEvent) messages.kick(client, 'misbehaved', 'unknown-event');
      }, endClient),
    );
    socket.on(
      'disconnect',
      guarded((reason: string) => {
        client.ended = true;
        clients.delete(client);
        messages.onDisconnect(client);
        log.debug({ room: client.pass.room, client: client.id, reason }, 'disconnected');
      }, endClient),
    );
  });

  const sweep = (): void => {
    const at = now();
    for (const client of clients) {
      const waitsToJoin = !client.ended && !client.joined;
      if (waitsToJoin && at - client.connectedAt > joinTimeout) messages.kick(client, 'misbehaved', 'no-join');
    }
    rooms.sweep(at);
  };
  const sweeping = repeat('the sweep of rooms', sweepMs, sweep);

  return async () => {
    clearInterval(sweeping);
    for (const client of clients) disconnect(client, 'stopping');
    rooms.clear();
    await new Promise((resolve) => setTimeout(resolve, 50));
    close();
  };
}
