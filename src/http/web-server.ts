import { once } from 'node:events';
import {
  createServer as createHttpServer,
  type Server as HttpServer,
  type IncomingMessage,
  type RequestListener,
  ServerResponse,
} from 'node:http';
import { createServer as createHttpsServer } from 'node:https';
import { type AddressInfo, createServer as createNetServer, type Server as NetServer, type Socket } from 'node:net';
import type { Duplex } from 'node:stream';
import { ConfigurationError } from './configuration-error';
import type { ConnectionLimiter } from './connection-limiter';
import { guarded } from './guarded';
import { HttpError, internalError } from './http-error';
import { hostProblem, parseRequestTarget } from './request-target';
import { announcesBody, closeAfterAnswer, errorResponse, sendError, sendRawResponse, sendResponse } from './response';
import type { SitePolicy } from './site-policy';

/** A private key and its certificate, PEM. */
export interface Credentials {
  readonly key: string;
  readonly cert: string;
}

export interface WebServer {
  readonly port: number;
  /** Stops listening and ends what is open; resolves when all is closed. */
  close(): Promise<void>;
}

/** Handles an upgrade request and returns true; false where the address has no WebSocket. */
export type UpgradeListener = (request: IncomingMessage, socket: Duplex, head: Buffer) => boolean;

/** The address on which a server listens; the port is the next free one where it is taken. */
interface ListenOptions {
  readonly host: string;
  readonly port: number;
}

interface WebServerOptions {
  readonly credentials?: Credentials;
  readonly upgrade?: UpgradeListener;
  /** Limits the connections of each address; every connection is accepted without it. */
  readonly connectionLimiter?: ConnectionLimiter;
  /** Checks the Host of requests that are redirected to https; every one is accepted without it. */
  readonly checkHost?: SitePolicy['checkHost'];
  /** Receives the exceptions of the listeners, after which the server goes on. Default: writes them to the console. */
  readonly onError?: ErrorListener;
  /**
   * Idle timeout of a connection [ms], also while a client does not read; WebSockets have their own pings. Default:
   * 30,000.
   */
  readonly idleTimeoutMs?: number;
}

/** The first byte of a TLS handshake record; no HTTP request begins with it. */
const tlsHandshake = 0x16;
/** Timeout of the TLS handshake and of the request headers [ms]. */
export const handshakeTimeoutMs = 5000;
/** Timeout of a whole request [ms]: 16 MB of motion at 1.1 Mbit/s. */
export const requestTimeoutMs = 120_000;
/** Interval at which Node checks these timeouts [ms]. */
const checkMs = 1000;

/** Returns a listener that redirects plain HTTP to https, because people omit the "https://". */
const redirectToHttps =
  (checkHost: SitePolicy['checkHost']): RequestListener =>
  (request, response) => {
    const host = request.headers.host;
    const target = parseRequestTarget(request.url);
    if (!target || !host || !/^[\w.:[\]-]+$/.test(host)) {
      sendError(request, response, new HttpError(400, 'the address of this request is malformed'));
      return;
    }
    const rejection = checkHost(request);
    if (rejection) {
      sendError(request, response, new HttpError(rejection.status, rejection.message));
      return;
    }
    const search = target.query.size > 0 ? `?${target.query}` : '';
    sendResponse(request, response, { status: 308, headers: { location: `https://${host}${target.path}${search}` } });
  };

/** Returns the refusal for an error of Node's HTTP parser. */
function rejectionOfParser({ code }: NodeJS.ErrnoException): HttpError {
  if (code === 'HPE_HEADER_OVERFLOW') return new HttpError(431, 'the headers of this request are too long');
  if (code === 'HPE_CHUNK_EXTENSIONS_OVERFLOW') return new HttpError(413, 'the chunks of this body are too long');
  if (code === 'ERR_HTTP_REQUEST_TIMEOUT') return new HttpError(408, 'the request did not arrive in time');
  return new HttpError(400, 'this is not an HTTP request');
}

/** Receives the exceptions of a server's handlers, for its log. */
type ErrorListener = (error: unknown) => void;

/** The responses that each connection has not sent yet, in the order of their requests. */
const unanswered = new WeakMap<Duplex, Set<ServerResponse>>();

const newestUnanswered = (socket: Duplex): ServerResponse | undefined => [...(unanswered.get(socket) ?? [])].at(-1);

/** Counts a response as unanswered until it is sent. */
export function followResponse({ socket }: IncomingMessage, response: ServerResponse): void {
  const responses = unanswered.get(socket) ?? new Set();
  unanswered.set(socket, responses.add(response));
  response.once('close', () => responses.delete(response));
}

/** Calls `next` when the connection has sent all earlier answers, unless one of them closes it. */
function afterEarlierAnswers(socket: Duplex, next: () => void): void {
  const newest = newestUnanswered(socket);
  if (newest) newest.once('close', () => afterEarlierAnswers(socket, next));
  else if (socket.writable) next();
}

/**
 * Returns a listener for requests that never throws and tolerates clients that disconnect. It refuses requests with a
 * wrong Host, and answers 500 to those whose listener throws.
 */
export const answering = (listener: RequestListener, onError: ErrorListener): RequestListener =>
  guarded(
    (request, response) => {
      followResponse(request, response);
      // A client may disconnect before it has read its answer; that is not an error.
      request.on('error', () => undefined);
      response.on('error', () => undefined);
      const problem = hostProblem(request);
      if (problem === null) listener(request, response);
      else sendError(request, response, new HttpError(400, problem));
    },
    (error, request, response) => {
      onError(error);
      if (response.headersSent) response.destroy();
      else sendError(request, response, internalError());
    },
  );

/** Returns the response to a request whose connection Node has handed over; the connection closes with it. */
export function lastResponse(request: IncomingMessage, socket: Duplex): ServerResponse {
  const response = new ServerResponse(request);
  response.shouldKeepAlive = false;
  response.assignSocket(socket as Socket);
  response.once('finish', () => closeAfterAnswer(socket));
  return response;
}

/**
 * Returns a listener for connections that Node hands over, of upgrades and of tunnels, that never throws. It refuses
 * requests with a wrong Host. The answers to earlier requests on the connection are sent before.
 */
export const handingOver =
  (listener: (request: IncomingMessage, socket: Duplex, head: Buffer) => void, onError: ErrorListener) =>
  (request: IncomingMessage, socket: Duplex, head: Buffer): void => {
    // Node has removed its own listeners.
    socket.on('error', () => socket.destroy()).on('timeout', () => socket.destroy());
    const answer = guarded(
      () => {
        const problem = hostProblem(request);
        if (problem === null) listener(request, socket, head);
        else sendError(request, lastResponse(request, socket), new HttpError(400, problem));
      },
      (error) => {
        onError(error);
        socket.destroy();
      },
    );
    afterEarlierAnswers(socket, answer);
  };

/**
 * Answers a request that offers another protocol as if it had none, and closes the connection. Requests with a body are
 * refused, because Node has not read it.
 */
export function ignoreOffer(server: HttpServer, request: IncomingMessage, socket: Duplex): void {
  const response = lastResponse(request, socket);
  if ((request.method === 'GET' || request.method === 'HEAD') && !announcesBody(request)) {
    // Node has set the timeout between two requests.
    response.setTimeout(server.timeout);
    server.emit('request', request, response);
  } else sendError(request, response, new HttpError(400, 'this address supports no upgrade'));
}

/** Attaches handlers for everything that reaches a server: requests, upgrades, tunnels and malformed input. */
function answerAll(
  server: HttpServer,
  listener: RequestListener,
  upgrade: UpgradeListener,
  onError: ErrorListener,
): void {
  // reason: missing in the types, but an option of http.Server: a client that has closed its side still receives the
  // answer.
  (server as HttpServer & { httpAllowHalfOpen: boolean }).httpAllowHalfOpen = true;
  server.on('request', answering(listener, onError));
  const rejectExpectation: RequestListener = (request, response) =>
    sendError(request, response, new HttpError(417, 'this server supports no expectation but 100-continue'));
  server.on('checkExpectation', answering(rejectExpectation, onError));
  const rejectTunnel = (request: IncomingMessage, socket: Duplex): void => {
    const rejection = new HttpError(405, 'this server is not a proxy', { headers: { allow: 'GET, HEAD' } });
    sendError(request, lastResponse(request, socket), rejection);
  };
  server.on('connect', handingOver(rejectTunnel, onError));
  const handleUpgrade = (request: IncomingMessage, socket: Duplex, head: Buffer): void => {
    if (!upgrade(request, socket, head)) ignoreOffer(server, request, socket);
  };
  server.on('upgrade', handingOver(handleUpgrade, onError));
  const rejectGarbage = (error: NodeJS.ErrnoException, socket: Duplex): void => {
    if (error.code === 'ECONNRESET') socket.destroy();
    if (!socket.writable) return;
    const rejection = rejectionOfParser(error);
    const newest = newestUnanswered(socket);
    if (newest && !newest.req.complete) {
      // The error is in the body of the newest request, and its response is sent in its turn.
      if (newest.headersSent) return;
      // Its handler may still wait for the body.
      newest.once('close', () => newest.req.destroy());
      sendError(newest.req, newest, rejection);
    } else {
      // Nothing more is read before the answer; Node reports an error for each chunk.
      socket.pause();
      afterEarlierAnswers(socket, () => sendRawResponse(socket, errorResponse(rejection)));
    }
  };
  server.on(
    'clientError',
    guarded(rejectGarbage, (error, _cause, socket) => {
      onError(error);
      socket.destroy();
    }),
  );
  server.on('tlsClientError', (_error: Error, socket: Socket) => socket.destroy());
}

/** Creates a server that splits one port: TLS goes to `secure`, plain HTTP to `plain`. */
function splitByProtocol(secure: HttpServer, plain: HttpServer, onError: ErrorListener): NetServer {
  return createNetServer((socket) => {
    socket.setTimeout(handshakeTimeoutMs, () => socket.destroy());
    socket.once('error', () => socket.destroy());
    const passOn = (chunk: Buffer): void => {
      socket.setTimeout(0);
      socket.removeAllListeners('timeout');
      socket.pause();
      socket.unshift(chunk);
      (chunk[0] === tlsHandshake ? secure : plain).emit('connection', socket);
      // The new owner reads only after it has attached its listeners.
      process.nextTick(() => socket.resume());
    };
    const endSocket = (error: unknown): void => {
      onError(error);
      socket.destroy();
    };
    socket.once('data', guarded(passOn, endSocket));
  });
}

const limits = {
  headersTimeout: handshakeTimeoutMs,
  requestTimeout: requestTimeoutMs,
  connectionsCheckingInterval: checkMs,
  // Answered by `hostProblem` instead, with a sentence and the security headers.
  requireHostHeader: false,
};

/** The number of ports that are tried. */
const portAttempts = 20;

/**
 * Listens on the port, or on the next free one of twenty, and resolves to that port; 0: any. Rejects with a
 * ConfigurationError if none is free or the system refuses.
 */
async function listenOnFreePort(server: NetServer, host: string, port: number): Promise<number> {
  for (let candidate = port; candidate < port + portAttempts && candidate <= 65535; candidate++) {
    try {
      server.listen(candidate, host);
      await once(server, 'listening');
      return (server.address() as AddressInfo).port;
    } catch (error) {
      const { code } = error as NodeJS.ErrnoException;
      if (code === 'EACCES') {
        throw new ConfigurationError(
          `This user may not listen on port ${candidate}. Choose one from 1024 up: npm start -- --port 3333`,
        );
      }
      if (code !== 'EADDRINUSE') throw error;
    }
  }
  throw new ConfigurationError(
    `Port ${port} and the ${portAttempts - 1} after it are in use. Choose another: npm start -- --port 4000`,
  );
}

/** A server that does not listen yet. */
interface PreparedServer {
  /** The server to which services with addresses of their own attach. */
  readonly http: HttpServer;
  listen(options: ListenOptions): Promise<WebServer>;
}

/** Prepares a server: HTTP, or with credentials HTTPS and a redirect from HTTP. */
export function prepareServer(
  listener: RequestListener,
  {
    credentials,
    upgrade = () => false,
    connectionLimiter,
    checkHost = () => null,
    onError = (error) => console.error(error),
    idleTimeoutMs = 30_000,
  }: WebServerOptions,
): PreparedServer {
  const requests: HttpServer = credentials
    ? createHttpsServer({ ...credentials, ...limits, handshakeTimeout: handshakeTimeoutMs })
    : createHttpServer(limits);
  answerAll(requests, listener, upgrade, onError);
  const redirects = createHttpServer(limits);
  answerAll(redirects, redirectToHttps(checkHost), () => false, onError);
  const entrance: NetServer = credentials ? splitByProtocol(requests, redirects, onError) : requests;
  for (const server of [requests, redirects]) {
    server.timeout = idleTimeoutMs;
    // Node starts to check timeouts on this event; a server that receives its connections from another never emits it.
    if (server !== entrance) server.emit('listening');
  }
  const sockets = new Set<Socket>();
  entrance.prependListener('connection', (socket: Socket) => {
    if (connectionLimiter?.admit(socket) === false) return;
    sockets.add(socket);
    socket.once('close', () => sockets.delete(socket));
  });
  const close = () =>
    new Promise<void>((resolve, reject) => {
      entrance.close((error) => (error ? reject(error) : resolve()));
      for (const socket of sockets) socket.destroy();
      // Stops their checks of timeouts.
      if (credentials) requests.close();
      redirects.close();
    });
  return {
    http: requests,
    async listen({ host, port }) {
      const chosen = await listenOnFreePort(entrance, host, port);
      // A connection that could not be accepted, for example without a free file handle.
      entrance.on('error', onError);
      return { port: chosen, close };
    },
  };
}
