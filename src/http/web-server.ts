import {
  createServer as createHttpServer,
  type Server as HttpServer,
  type IncomingMessage,
  type RequestListener,
  ServerResponse,
} from 'node:http';
import { createServer as createHttpsServer } from 'node:https';
import { createServer as createNetServer, type Server as NetServer, type Socket } from 'node:net';
import type { Duplex } from 'node:stream';
import { HttpError, refusal, sendAnswer, sendRawAnswer } from './answer';
import type { ConnectionLimiter } from './connection-limiter';
import { listenOnFreePort } from './listen';
import { complaintAboutHost, targetOf } from './target';

/** A private key and its certificate, PEM. */
export interface Credentials {
  readonly key: string;
  readonly cert: string;
}

/** A page being served. */
export interface WebServer {
  readonly port: number;
  /** Stops listening and ends what is open; resolves when all is closed. */
  close(): Promise<void>;
}

/** Takes a connection that asks to become a WebSocket and returns true; false where this address has none. */
export type UpgradeListener = (request: IncomingMessage, socket: Duplex, head: Buffer) => boolean;

export interface ServeOptions {
  readonly host: string;
  readonly port: number;
  readonly credentials?: Credentials;
  readonly upgrade?: UpgradeListener;
  /** Limits the connections of each address; every connection is accepted without it. */
  readonly connectionLimiter?: ConnectionLimiter;
  /** A connection on which nothing moves for so long [ms], an answer that is not read included, is ended; WebSockets have their own pings. */
  readonly silenceMs?: number;
}

/** The first byte of a TLS handshake record; no HTTP request begins with it. */
const tlsHandshake = 0x16;
/** A connection that has not said within this time [ms] what it wants is ended: TLS handshake and the head of a request alike. */
export const handshakeMs = 5000;
/** So long a request may take to arrive whole [ms]: 16 MB of motion at 1.1 Mbit/s. */
export const requestMs = 120_000;
/** How often connections are looked at for that [ms]. */
const checkMs = 1000;

/** Answers plain HTTP with the same address under https: people leave the "https://" out. */
const redirectToHttps: RequestListener = (request, response) => {
  const host = request.headers.host;
  const target = targetOf(request.url);
  if (!target || !host || !/^[\w.:[\]-]+$/.test(host)) {
    sendAnswer(request, response, refusal(new HttpError(400, 'this address is not well formed')));
    return;
  }
  const search = target.query.size > 0 ? `?${target.query}` : '';
  sendAnswer(request, response, { status: 308, headers: { location: `https://${host}${target.path}${search}` } });
};

/** What the parser of Node found wrong with a request. */
function refusalOfParser({ code }: NodeJS.ErrnoException): HttpError {
  if (code === 'HPE_HEADER_OVERFLOW') return new HttpError(431, 'the head of this request is too long');
  if (code === 'HPE_CHUNK_EXTENSIONS_OVERFLOW') return new HttpError(413, 'the chunks of this body are too long');
  if (code === 'ERR_HTTP_REQUEST_TIMEOUT') return new HttpError(408, 'the request did not arrive in time');
  return new HttpError(400, 'this is no HTTP request');
}

/** Answers all that arrives at this server: requests, upgrades, tunnels and what is none of them. */
function answerAll(server: HttpServer, listener: RequestListener, upgrade: UpgradeListener): void {
  const answering = new WeakMap<Duplex, ServerResponse>();
  const refused = new WeakSet<Duplex>();

  const guarded = (request: IncomingMessage, response: Parameters<RequestListener>[1]): void => {
    answering.set(request.socket, response);
    // A connection that ends while its answer is on the way is no fault of ours.
    request.on('error', () => undefined);
    response.on('error', () => undefined);
    const complaint = complaintAboutHost(request);
    if (complaint !== null) {
      sendAnswer(request, response, refusal(new HttpError(400, complaint)));
      return;
    }
    listener(request, response);
  };

  // reason: not in the types, yet Node's own switch (http.Server): a client that has said all and closed its side still hears the answer.
  (server as HttpServer & { httpAllowHalfOpen: boolean }).httpAllowHalfOpen = true;
  server.on('request', guarded);
  server.on('checkExpectation', (request: IncomingMessage, response: ServerResponse) => {
    sendAnswer(request, response, refusal(new HttpError(417, 'no expectation but 100-continue is met here')));
  });
  server.on('connect', (_request: IncomingMessage, socket: Duplex) => {
    socket.on('error', () => socket.destroy());
    sendRawAnswer(socket, refusal(new HttpError(405, 'this server is no proxy', { headers: { allow: 'GET, HEAD' } })));
  });
  server.on('upgrade', (request: IncomingMessage, socket: Duplex, head: Buffer) => {
    socket.on('error', () => socket.destroy());
    const complaint = complaintAboutHost(request);
    if (complaint !== null) {
      sendRawAnswer(socket, refusal(new HttpError(400, complaint)));
      return;
    }
    if (upgrade(request, socket, head)) return;
    if (head.length > 0) {
      sendRawAnswer(socket, refusal(new HttpError(400, 'there is nothing to upgrade to at this address')));
      return;
    }
    // An offer of another protocol may be passed over: the request is answered as if it had made none.
    const response = new ServerResponse(request);
    response.shouldKeepAlive = false;
    response.assignSocket(socket as Socket);
    response.once('finish', () => socket.end());
    guarded(request, response);
  });
  server.on('clientError', (error: NodeJS.ErrnoException, socket: Duplex) => {
    if (refused.has(socket)) return;
    if (error.code === 'ECONNRESET' || !socket.writable) {
      socket.destroy();
      return;
    }
    const response = answering.get(socket);
    if (response?.headersSent && !response.writableEnded) {
      // Its answer is on the way, and the connection ends with it: what is wrong is the rest of a body that was not wanted.
      response.end();
      return;
    }
    refused.add(socket);
    sendRawAnswer(socket, refusal(refusalOfParser(error)));
  });
  server.on('tlsClientError', (_error: Error, socket: Socket) => socket.destroy());
}

/** One port for both: TLS goes to the page, plain HTTP is told to use TLS. */
function divide(secure: HttpServer, plain: HttpServer): NetServer {
  return createNetServer((socket) => {
    socket.setTimeout(handshakeMs, () => socket.destroy());
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
  headersTimeout: handshakeMs,
  requestTimeout: requestMs,
  connectionsCheckingInterval: checkMs,
  // Said in a sentence and with our headers instead.
  requireHostHeader: false,
};

/** Serves on the port or the next free one: HTTP, or with credentials HTTPS (and HTTP only as a redirect to it). */
export async function serve(
  listener: RequestListener,
  { host, port, credentials, upgrade = () => false, connectionLimiter, silenceMs = 30_000 }: ServeOptions,
): Promise<WebServer> {
  const requests: HttpServer = credentials
    ? createHttpsServer({ ...credentials, ...limits, handshakeTimeout: handshakeMs })
    : createHttpServer(limits);
  answerAll(requests, listener, upgrade);
  const redirects = createHttpServer(limits);
  answerAll(redirects, redirectToHttps, () => false);
  const entrance: NetServer = credentials ? divide(requests, redirects) : requests;
  for (const server of [requests, redirects]) {
    server.timeout = silenceMs;
    // Node keeps its deadlines from then on; a server that is handed its connections never hears it.
    if (server !== entrance) server.emit('listening');
  }
  const sockets = new Set<Socket>();
  entrance.prependListener('connection', (socket: Socket) => {
    if (connectionLimiter?.admit(socket) === false) return;
    sockets.add(socket);
    socket.once('close', () => sockets.delete(socket));
  });
  const actualPort = await listenOnFreePort(entrance, host, port);
  return {
    port: actualPort,
    close: () =>
      new Promise((resolve, reject) => {
        entrance.close((error) => (error ? reject(error) : resolve()));
        for (const socket of sockets) socket.destroy();
        // Ends their watch over deadlines.
        if (credentials) requests.close();
        redirects.close();
      }),
  };
}
