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
import { HttpError } from './http-error';
import { hostProblem, parseRequestTarget } from './request-target';
import { errorResponse, sendError, sendRawResponse, sendResponse } from './response';

/** A private key and its certificate, PEM. */
export interface Credentials {
  readonly key: string;
  readonly cert: string;
}

/** A listening server. */
export interface WebServer {
  readonly port: number;
  /** Stops listening and ends what is open; resolves when all is closed. */
  close(): Promise<void>;
}

/** Handles an upgrade request and returns true; false where the address has no WebSocket. */
export type UpgradeListener = (request: IncomingMessage, socket: Duplex, head: Buffer) => boolean;

/** The address on which a server listens; the port is the next free one where it is taken. */
export interface ListenOptions {
  readonly host: string;
  readonly port: number;
}

export interface WebServerOptions {
  readonly credentials?: Credentials;
  readonly upgrade?: UpgradeListener;
  /** Limits the connections of each address; every connection is accepted without it. */
  readonly connectionLimiter?: ConnectionLimiter;
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

/** Redirects plain HTTP to https, because people omit the "https://". */
const redirectToHttps: RequestListener = (request, response) => {
  const host = request.headers.host;
  const target = parseRequestTarget(request.url);
  if (!target || !host || !/^[\w.:[\]-]+$/.test(host)) {
    sendError(request, response, new HttpError(400, 'the address of this request is malformed'));
    return;
  }
  const search = target.query.size > 0 ? `?${target.query}` : '';
  sendResponse(request, response, { status: 308, headers: { location: `https://${host}${target.path}${search}` } });
};

/** Returns the refusal for an error of Node's HTTP parser. */
function refusalOfParser({ code }: NodeJS.ErrnoException): HttpError {
  if (code === 'HPE_HEADER_OVERFLOW') return new HttpError(431, 'the headers of this request are too long');
  if (code === 'HPE_CHUNK_EXTENSIONS_OVERFLOW') return new HttpError(413, 'the chunks of this body are too long');
  if (code === 'ERR_HTTP_REQUEST_TIMEOUT') return new HttpError(408, 'the request did not arrive in time');
  return new HttpError(400, 'this is not an HTTP request');
}

/** Refuses requests with a wrong Host before the listener, and tolerates clients that disconnect. */
export const withHostCheck =
  (listener: RequestListener): RequestListener =>
  (request, response) => {
    // A client may disconnect before it has read its answer; that is not an error.
    request.on('error', () => undefined);
    response.on('error', () => undefined);
    const complaint = hostProblem(request);
    if (complaint === null) listener(request, response);
    else sendError(request, response, new HttpError(400, complaint));
  };

/** Answers an upgrade request with a wrong Host; returns whether it did. */
export function refusesUpgrade(request: IncomingMessage, socket: Duplex): boolean {
  const complaint = hostProblem(request);
  if (complaint !== null) sendRawResponse(socket, errorResponse(new HttpError(400, complaint)));
  return complaint !== null;
}

/** The response that each connection waits for. */
const answering = new WeakMap<Duplex, ServerResponse>();

class FollowedResponse extends ServerResponse {
  override assignSocket(socket: Socket): void {
    answering.set(socket, this);
    super.assignSocket(socket);
  }
}

/** Attaches handlers for everything that reaches a server: requests, upgrades, tunnels and malformed input. */
function answerAll(server: HttpServer, listener: RequestListener, upgrade: UpgradeListener): void {
  const refused = new WeakSet<Duplex>();

  // reason: missing in the types, but an option of http.Server: a client that has closed its side still receives the
  // answer.
  (server as HttpServer & { httpAllowHalfOpen: boolean }).httpAllowHalfOpen = true;
  server.on('request', withHostCheck(listener));
  server.on('checkExpectation', (request: IncomingMessage, response: ServerResponse) => {
    sendError(request, response, new HttpError(417, 'this server supports no expectation but 100-continue'));
  });
  server.on('connect', (_request: IncomingMessage, socket: Duplex) => {
    socket.on('error', () => socket.destroy());
    sendRawResponse(
      socket,
      errorResponse(new HttpError(405, 'this server is not a proxy', { headers: { allow: 'GET, HEAD' } })),
    );
  });
  server.on('upgrade', (request: IncomingMessage, socket: Duplex, head: Buffer) => {
    socket.on('error', () => socket.destroy());
    if (refusesUpgrade(request, socket) || upgrade(request, socket, head)) return;
    if (head.length > 0) {
      sendRawResponse(socket, errorResponse(new HttpError(400, 'this address supports no upgrade')));
      return;
    }
    // A server may ignore an offer of another protocol; the request is answered as if it had none.
    const response = new FollowedResponse(request);
    response.shouldKeepAlive = false;
    response.assignSocket(socket as Socket);
    response.once('finish', () => socket.end());
    server.emit('request', request, response);
  });
  server.on('clientError', (error: NodeJS.ErrnoException, socket: Duplex) => {
    if (refused.has(socket)) return;
    if (error.code === 'ECONNRESET' || !socket.writable) {
      socket.destroy();
      return;
    }
    const response = answering.get(socket);
    if (response?.headersSent && !response.writableEnded) {
      // The answer is being sent and closes the connection; the error is in the rest of an unread body.
      response.end();
      return;
    }
    refused.add(socket);
    sendRawResponse(socket, errorResponse(refusalOfParser(error)));
  });
  server.on('tlsClientError', (_error: Error, socket: Socket) => socket.destroy());
}

/** Creates a server that splits one port: TLS goes to `secure`, plain HTTP to `plain`. */
function splitByProtocol(secure: HttpServer, plain: HttpServer): NetServer {
  return createNetServer((socket) => {
    socket.setTimeout(handshakeTimeoutMs, () => socket.destroy());
    socket.once('error', () => socket.destroy());
    socket.once('data', (chunk: Buffer) => {
      socket.setTimeout(0);
      socket.removeAllListeners('timeout');
      socket.pause();
      socket.unshift(chunk);
      (chunk[0] === tlsHandshake ? secure : plain).emit('connection', socket);
      // The new owner reads only after it has attached its listeners.
      process.nextTick(() => socket.resume());
    });
  });
}

const limits = {
  headersTimeout: handshakeTimeoutMs,
  requestTimeout: requestTimeoutMs,
  connectionsCheckingInterval: checkMs,
  // Answered by `hostProblem` instead, with a sentence and the security headers.
  requireHostHeader: false,
  ServerResponse: FollowedResponse,
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
export interface PreparedServer {
  /** The server to which services with addresses of their own attach. */
  readonly http: HttpServer;
  listen(options: ListenOptions): Promise<WebServer>;
}

/** Prepares a server: HTTP, or with credentials HTTPS and a redirect from HTTP. */
export function prepareServer(
  listener: RequestListener,
  { credentials, upgrade = () => false, connectionLimiter, idleTimeoutMs = 30_000 }: WebServerOptions,
): PreparedServer {
  const requests: HttpServer = credentials
    ? createHttpsServer({ ...credentials, ...limits, handshakeTimeout: handshakeTimeoutMs })
    : createHttpServer(limits);
  answerAll(requests, listener, upgrade);
  const redirects = createHttpServer(limits);
  answerAll(redirects, redirectToHttps, () => false);
  const entrance: NetServer = credentials ? splitByProtocol(requests, redirects) : requests;
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
    listen: async ({ host, port }) => ({ port: await listenOnFreePort(entrance, host, port), close }),
  };
}

/** Prepares a server and listens. */
export const serve = (
  listener: RequestListener,
  { host, port, ...options }: WebServerOptions & ListenOptions,
): Promise<WebServer> => prepareServer(listener, options).listen({ host, port });
