import { createServer, type IncomingMessage } from 'node:http';
import type { Socket as NetSocket } from 'node:net';
import type { Duplex } from 'node:stream';
import { Server, type Socket } from 'socket.io';
import { guarded, HttpError, handshakeTimeoutMs, lastResponse, parseRequestTarget, sendError } from 'threepoint-http';
import { maxMessageBytes, relayParser, TokenBucket } from 'threepoint-rooms/host';
import { WebSocket, WebSocketServer } from 'ws';
import type { RelayContext } from '../relay-context';
import { maxQueuedBytes, SlowReaders } from './slow-readers';
import { createUpgradeAdmission } from './upgrade-admission';

/** The path of the relay's WebSockets. */
export const relayPath = '/relay';

/** Why the transport ends a connection: it sends too many frames, or reads too slowly. */
export type WireFault = 'flood' | 'slow';

/** Receives what a connection sends besides socket.io's packets. */
export interface WireListener {
  onPose(bytes: Uint8Array): void;
  /** Called once before the transport ends the connection; further messages are dropped. */
  onFault(fault: WireFault): void;
}

/**
 * A connection is destroyed this long after it was closed [ms], whether or not the client has read the last message.
 */
const closingMs = 1000;

/**
 * The most frames of any kind that a connection may send [1/s], before and after it joins a room: messages, poses,
 * acknowledgements, pings and pongs. A page sends 40 poses, 20 messages and 20 signals a second (80 signals in a
 * burst), and after an outage what it queued for 5 s.
 */
const framesPerSecond = 300;

/** Destroys a socket that its client does not close in time. */
const destroySoon = (raw: NetSocket | undefined): void => {
  if (raw && !raw.destroyed) setTimeout(() => raw.destroy(), closingMs).unref();
};

/** Closes a connection, even where the client reads nothing. */
export function closeConnection(socket: Socket): void {
  const raw: NetSocket | undefined = socket.conn.request?.socket;
  socket.disconnect(true);
  destroySoon(raw);
}

/** Returns a WebSocket server for Engine.IO that passes each new connection to `onOpen` first. */
const webSocketServer = (onOpen: (websocket: WebSocket, request: IncomingMessage) => void) =>
  class extends WebSocketServer {
    override handleUpgrade(...[request, socket, head, done]: Parameters<WebSocketServer['handleUpgrade']>): void {
      super.handleUpgrade(request, socket, head, (websocket, upgraded) => {
        onOpen(websocket, request);
        done(websocket, upgraded);
      });
    }
  };

/**
 * Counts the frames of a connection. Beyond the limit it is read no further, and `onFlood` is called once. `now`:
 * seconds, monotonic.
 */
function limitFrames(websocket: WebSocket, now: () => number, onFlood: () => void): void {
  const bucket = new TokenBucket(framesPerSecond);
  const count = () => {
    if (websocket.isPaused || bucket.take(now())) return;
    websocket.pause();
    // Earlier packets are still on their way through socket.io, which takes a tick for each.
    setImmediate(onFlood);
  };
  websocket.on('message', count).on('ping', count).on('pong', count);
}

export type RelayTransport = ReturnType<typeof createRelayTransport>;

/** The WebSockets of a relay: opens them, passes on what they receive, and ends those that harm others. */
export function createRelayTransport(context: RelayContext) {
  const { log, metrics, now } = context;
  const admit = createUpgradeAdmission(context);
  const io = new Server(createServer(), {
    path: relayPath,
    serveClient: false,
    connectTimeout: handshakeTimeoutMs,
    parser: relayParser,
    transports: ['websocket'],
    allowUpgrades: false,
    perMessageDeflate: false,
    maxHttpBufferSize: maxMessageBytes,
    wsEngine: webSocketServer((websocket, request) => void websockets.set(request, websocket)),
    // A page that hangs, or reads nothing, is detected within seven seconds.
    pingInterval: 3000,
    pingTimeout: 4000,
  });
  const { engine } = io;
  const websockets = new WeakMap<IncomingMessage, WebSocket>();
  const listeners = new WeakMap<Socket['conn'], WireListener>();
  function end(conn: Socket['conn'], fault: WireFault): void {
    const listener = listeners.get(conn);
    if (listener) listener.onFault(fault);
    else {
      metrics.kicked(fault);
      log.warn({ because: fault }, 'ended a connection that had not joined');
    }
    // A client that has left its room may still be connected.
    conn.close();
    destroySoon(conn.request.socket);
  }
  const slowReaders = new SlowReaders(now, (conn) => end(conn, 'slow'));
  engine.on('connection', (conn: Socket['conn']) => {
    const raw = conn.request.socket;
    slowReaders.watch(conn);
    const websocket = websockets.get(conn.request);
    if (websocket) limitFrames(websocket, now, () => end(conn, 'flood'));
    const onMessage = (message: Buffer, isBinary: boolean): void => {
      if (!isBinary) return;
      const listener = listeners.get(conn);
      if (listener) listener.onPose(message);
      else conn.close();
    };
    const onFault = (error: unknown): void => {
      log.error({ error: String(error) }, 'a frame failed');
      conn.close();
    };
    websocket?.on('message', guarded(onMessage, onFault));
    conn.once('close', () => destroySoon(raw));
  });

  return {
    io,
    /** The number of open WebSockets, silent ones included. */
    get sockets(): number {
      return engine.clientsCount;
    },
    /**
     * Registers the listener for a connection's poses. Binary messages are poses, which socket.io's decoder ignores. A
     * binary message on a connection without a listener closes it.
     */
    listen: (socket: Socket, listener: WireListener): void => void listeners.set(socket.conn, listener),
    /**
     * Sends a frame of poses past the queues of socket.io and Engine.IO, which cost as much as the system call. Returns
     * whether it was sent: a connection on which bytes wait misses it.
     */
    sendFrame({ conn }: Socket, frame: Uint8Array): boolean {
      const websocket = websockets.get(conn.request);
      if (websocket?.readyState !== WebSocket.OPEN || websocket.bufferedAmount > maxQueuedBytes) return false;
      websocket.send(frame);
      return true;
    },
    /** Opens a WebSocket, or answers why it is refused. Returns false where the path is not the relay's. */
    upgrade(request: IncomingMessage, socket: Duplex, head: Buffer): boolean {
      const target = parseRequestTarget(request.url);
      if (!target || target.path.replace(/\/$/, '') !== relayPath) return false;
      try {
        socket.once('close', admit(request, target.query));
      } catch (error) {
        if (!(error instanceof HttpError)) throw error;
        sendError(request, lastResponse(request, socket), error);
        return true;
      }
      engine.handleUpgrade(request as never, socket, head);
      return true;
    },
    close(): void {
      slowReaders.stop();
      io.disconnectSockets(true);
      engine.close();
    },
  };
}
