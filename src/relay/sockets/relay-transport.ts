import { createServer, type IncomingMessage } from 'node:http';
import type { Socket as NetSocket } from 'node:net';
import { Server, type Socket } from 'socket.io';
import {
  guarded,
  HttpError,
  handshakeTimeoutMs,
  lastResponse,
  parseRequestTarget,
  sendError,
  type UpgradeListener,
} from 'threepoint-http';
import { maxMessageBytes, relayParser, TokenBucket } from 'threepoint-rooms/host';
import { WebSocket, WebSocketServer } from 'ws';
import type { RelayContext } from '../relay-context';
import { maxQueuedBytes, SlowReaders } from './slow-readers';
import { createUpgradeAdmission } from './upgrade-admission';

/** The path of the relay's WebSockets. */
export const relayPath = '/relay';

/** A connection of Engine.IO. */
type Connection = Socket['conn'];

/** Why the transport ends a connection: it sends too many frames, or reads too slowly. */
export type WireProblem = 'flood' | 'slow';

/** Receives what a connection sends besides socket.io's packets. */
interface WireListener {
  onPose(bytes: Uint8Array): void;
  /** Called once before the transport ends the connection; further messages are dropped. */
  onError(problem: WireProblem): void;
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

/** Returns socket.io's server of the relay, which passes each new WebSocket to `onOpen` first. */
const createSocketServer = (onOpen: (websocket: WebSocket, request: IncomingMessage) => void): Server =>
  new Server(createServer(), {
    path: relayPath,
    serveClient: false,
    connectTimeout: handshakeTimeoutMs,
    parser: relayParser,
    transports: ['websocket'],
    allowUpgrades: false,
    perMessageDeflate: false,
    maxHttpBufferSize: maxMessageBytes,
    wsEngine: webSocketServer(onOpen),
    // A page that hangs, or reads nothing, is detected within seven seconds.
    pingInterval: 3000,
    pingTimeout: 4000,
  });

/**
 * Returns the listener for requests of upgrades: it opens a WebSocket, or answers why it is refused. It returns false
 * where the path is not the relay's.
 */
function createUpgradeListener(context: RelayContext, { engine }: Server): UpgradeListener {
  const admit = createUpgradeAdmission(context);
  return (request, socket, head) => {
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
  };
}

export type RelayTransport = ReturnType<typeof createRelayTransport>;

/** The WebSockets of a relay: opens them, passes on what they receive, and ends those that harm others. */
export function createRelayTransport(context: RelayContext) {
  const { log, metrics, now } = context;
  const websockets = new WeakMap<IncomingMessage, WebSocket>();
  const listeners = new WeakMap<Connection, WireListener>();
  const io = createSocketServer((websocket, request) => void websockets.set(request, websocket));
  const { engine } = io;
  const slowReaders = new SlowReaders(context, (conn) => end(conn, 'slow'));

  function end(conn: Connection, problem: WireProblem): void {
    const listener = listeners.get(conn);
    if (listener) listener.onError(problem);
    else {
      metrics.kicked(problem);
      log.warn({ because: problem }, 'ended a connection that had not joined');
    }
    // A client that has left its room may still be connected.
    conn.close();
    destroySoon(conn.request.socket);
  }

  /** Passes binary messages to the listener of a connection; one without a listener is closed. */
  function receivePoses(conn: Connection, websocket: WebSocket): void {
    const onMessage = (message: Buffer, isBinary: boolean): void => {
      if (!isBinary) return;
      const listener = listeners.get(conn);
      if (listener) listener.onPose(message);
      else conn.close();
    };
    const onError = (error: unknown): void => {
      log.error({ error: String(error) }, 'a frame failed');
      conn.close();
    };
    websocket.on('message', guarded(onMessage, onError));
  }

  engine.on('connection', (conn: Connection) => {
    const raw = conn.request.socket;
    slowReaders.watch(conn);
    const websocket = websockets.get(conn.request);
    if (websocket) {
      limitFrames(websocket, now, () => end(conn, 'flood'));
      receivePoses(conn, websocket);
    }
    conn.once('close', () => destroySoon(raw));
  });

  return {
    io,
    /** The number of open WebSockets, silent ones included. */
    get sockets(): number {
      return engine.clientsCount;
    },
    /** Registers the listener for a connection's poses: binary messages, which socket.io's decoder ignores. */
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
    upgrade: createUpgradeListener(context, io),
    close(): void {
      slowReaders.stop();
      io.disconnectSockets(true);
      engine.close();
    },
  };
}
