import type { EventEmitter } from 'node:events';
import type { IncomingMessage } from 'node:http';
import type { Socket as NetSocket } from 'node:net';
import type { Duplex } from 'node:stream';
import { Server as Engine } from 'engine.io';
import type { Logger } from 'pino';
import { Server, type Socket } from 'socket.io';
import { HttpError, refusal, sendRawAnswer } from 'threepoint-http/answer';
import { type ClientAddress, clientAddressOf } from 'threepoint-http/client-address';
import { createSlotCounter } from 'threepoint-http/connection-limiter';
import { createSitePolicy } from 'threepoint-http/site-policy';
import { targetOf } from 'threepoint-http/target';
import { handshakeMs } from 'threepoint-http/web-server';
import { longestMessage } from '../../protocol/messages';
import { relayParser } from '../../protocol/socket-parsers';
import { TokenBucket } from '../../room/token-bucket';
import type { RelayConfiguration } from '../settings/relay-configuration';
import type { RelayMetrics } from '../settings/relay-metrics';
import { type ReceivingWebSocket, takeShortMessages } from '../short-messages';
import { SlowReaders } from './slow-readers';

/** Where the relay is found on its server. */
export const relayPath = '/relay';

/** Why the transport ends a connection that harms others: it sent more than `framesPerSecond`, or reads too slowly. */
export type WireFault = 'flood' | 'slow';

/** What is heard of a connection below socket.io. */
export interface WireListener {
  onPose(bytes: Uint8Array): void;
  /** No more is heard, and the connection ends after this. */
  onFault(fault: WireFault): void;
}

/**
 * More frames in a second than this, of whatever kind, are an attack: messages, poses, acknowledgements, pings and answers to pings, before
 * a room is joined and after. A page sends 40 poses, 20 messages of its own and 20 signals a second, 80 of these at once, and what waited for its
 * network for 5 s at once.
 */
const framesPerSecond = 300;
/** WebSockets below the rooms: who may open one, and how all of them end. */
export interface RelayTransport {
  readonly io: Server;
  /** Every WebSocket that is open, silent ones included. */
  readonly sockets: number;
  /**
   * Binary messages are poses and pass Engine.IO and socket.io by, which do more with a message than a room with a pose. A connection that
   * sends one without having a listener is closed, and so is one that floods the relay.
   */
  listen(socket: Socket, listener: WireListener): void;
  /** Opens a WebSocket, or answers why not; false where the address is not the relay's. */
  upgrade(request: IncomingMessage, socket: Duplex, head: Buffer): boolean;
  close(): void;
}

/** After a farewell the connection is torn down within this [ms], whether or not the other side reads. */
const farewellMs = 1000;

/** What the other side does not close is closed for it. */
const destroySoon = (raw: NetSocket | undefined): void => {
  if (raw && !raw.destroyed) setTimeout(() => raw.destroy(), farewellMs).unref();
};

/** Ends the connection however little the other side reads. */
export function closeConnection(socket: Socket): void {
  const raw: NetSocket | undefined = socket.conn.request?.socket;
  socket.disconnect(true);
  destroySoon(raw);
}

/** Why this is no request for a WebSocket of the relay's protocol; null: it is one. */
function complaintAbout({ method, headers }: IncomingMessage, query: URLSearchParams): HttpError | null {
  if (
    method !== 'GET' ||
    headers.upgrade?.toLowerCase() !== 'websocket' ||
    !/^[+/0-9A-Za-z]{22}==$/.test(headers['sec-websocket-key'] ?? '')
  ) {
    return new HttpError(400, 'this is no request for a WebSocket');
  }
  if (headers['sec-websocket-version'] !== '13') {
    return new HttpError(426, 'WebSockets have version 13 here', { headers: { 'sec-websocket-version': '13' } });
  }
  if (query.get('EIO') !== '4' || query.get('transport') !== 'websocket' || query.has('sid')) {
    return new HttpError(400, 'the relay speaks Engine.IO 4 over WebSockets alone');
  }
  return null;
}

/** Lets `listener` have a connection's binary messages; Engine.IO gets the others, as before. `take`: whether a frame is to be heard at all. */
function divert(conn: Socket['conn'], take: () => boolean, listener: (bytes: Uint8Array) => void): void {
  // reason: Engine.IO leaves the WebSocket there for its own transport, and does not say so in its types.
  const { websocket } = conn.request as unknown as { readonly websocket: EventEmitter & ReceivingWebSocket };
  for (const engines of websocket.listeners('message')) {
    websocket.off('message', engines as () => void);
    websocket.on('message', (received: Buffer, isBinary: boolean) => {
      if (!take()) return;
      if (isBinary) listener(received);
      else engines.call(websocket, received, isBinary);
    });
  }
  websocket.on('ping', take);
  websocket.on('pong', take);
  takeShortMessages(websocket, (bytes) => {
    if (take()) listener(bytes);
  });
}

/**
 * Watches how often a connection sends: the function it gives says of each frame whether it is to be heard. From the first frame too many on
 * none is, and `end` is called once. `now`: seconds, monotonic.
 */
function createFloodWatch(now: () => number, end: () => void): () => boolean {
  const bucket = new TokenBucket(framesPerSecond);
  let floods = false;
  return () => {
    if (floods || bucket.take(now())) return !floods;
    floods = true;
    // What came before is still on its way through socket.io, which lets a tick pass for each packet.
    setImmediate(end);
    return false;
  };
}

/** Opens WebSockets at `relayPath`, so many for each address. `now`: seconds, monotonic. */
export function createRelayTransport(
  configuration: RelayConfiguration,
  { log, metrics, now }: { readonly log: Logger; readonly metrics: RelayMetrics; readonly now: () => number },
): RelayTransport {
  const addresses = createSlotCounter(configuration.connectionsPerAddress);
  const site = createSitePolicy(configuration);
  const engine = new Engine({
    transports: ['websocket'],
    allowUpgrades: false,
    perMessageDeflate: false,
    maxHttpBufferSize: longestMessage,
    // A page that hangs, and a reader that stalls behind full buffers, is found out within seven seconds.
    pingInterval: 3000,
    pingTimeout: 4000,
  });
  const io = new Server({ serveClient: false, connectTimeout: handshakeMs, parser: relayParser });
  io.bind(engine);
  const listeners = new WeakMap<Socket['conn'], WireListener>();
  function end(conn: Socket['conn'], fault: WireFault): void {
    const listener = listeners.get(conn);
    if (listener) listener.onFault(fault);
    else {
      metrics.kicked(fault);
      log.warn({ because: fault }, 'a connection without a place was ended');
    }
    // A client who has left the rooms may still have the connection.
    conn.close();
    destroySoon(conn.request.socket);
  }
  const slowReaders = new SlowReaders(now, (conn) => end(conn, 'slow'));
  engine.on('connection', (conn: Socket['conn']) => {
    const raw = conn.request.socket;
    slowReaders.watch(conn);
    const take = createFloodWatch(now, () => end(conn, 'flood'));
    divert(conn, take, (bytes) => {
      const listener = listeners.get(conn);
      if (listener) listener.onPose(bytes);
      else conn.close();
    });
    conn.once('close', () => destroySoon(raw));
  });

  /** Takes a place for a WebSocket of the client's address, or throws an HttpError that says why it is refused. */
  function admit(request: IncomingMessage, query: URLSearchParams): ClientAddress {
    const complaint = complaintAbout(request, query);
    if (complaint) throw complaint;
    const stranger = site.refusalOfHost(request) ?? site.refusalOfOrigin(request);
    if (stranger) {
      metrics.kicked('origin');
      log.warn({ origin: request.headers.origin, host: request.headers.host }, 'origin refused');
      throw new HttpError(stranger.status, stranger.message);
    }
    const address = clientAddressOf(request, configuration.trustProxy);
    if (!addresses.acquire(address.network)) {
      metrics.kicked('connections');
      throw new HttpError(429, `an address has at most ${configuration.connectionsPerAddress} connections here`);
    }
    return address;
  }

  return {
    io,
    get sockets() {
      return engine.clientsCount;
    },
    listen: (socket, listener) => void listeners.set(socket.conn, listener),
    upgrade(request, socket, head) {
      const target = targetOf(request.url);
      if (!target || target.path.replace(/\/$/, '') !== relayPath) return false;
      try {
        const { network } = admit(request, target.query);
        socket.once('close', () => addresses.release(network));
      } catch (error) {
        if (!(error instanceof HttpError)) throw error;
        sendRawAnswer(socket, refusal(error));
        return true;
      }
      engine.handleUpgrade(request as never, socket, head);
      return true;
    },
    close() {
      slowReaders.stop();
      io.disconnectSockets(true);
      engine.close();
    },
  };
}
