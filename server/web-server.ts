import { createServer as createHttpServer, type Server as HttpServer, type RequestListener } from 'node:http';
import { createServer as createHttpsServer } from 'node:https';
import { createServer as createNetServer, type Server as NetServer, type Socket } from 'node:net';
import type { Credentials } from './certificate';
import { listenOnFreePort } from './listen';
import { securityHeaders } from './security-headers';

/** A page being served. */
export interface WebServer {
  readonly port: number;
  /** Where requests arrive: what wants upgrades (a relay) attaches itself here. */
  readonly requests: HttpServer;
  /** Stops listening and ends what is open; resolves when all is closed. */
  close(): Promise<void>;
}

/** The first byte of a TLS handshake record; no HTTP request begins with it. */
const tlsHandshake = 0x16;
const firstByteTimeoutMs = 10_000;

/** Answers plain HTTP with the same address under https: people leave the "https://" out. */
const redirectToHttps: RequestListener = (request, response) => {
  const host = request.headers.host;
  if (!host || !/^[\w.:[\]-]+$/.test(host)) {
    response.writeHead(400, securityHeaders);
    response.end();
    return;
  }
  response.writeHead(308, { ...securityHeaders, location: `https://${host}${request.url ?? '/'}` });
  response.end();
};

/** One port for both: TLS goes to the page, plain HTTP is told to use TLS. */
function divide(secure: HttpServer, plain: HttpServer): NetServer {
  return createNetServer((socket) => {
    socket.setTimeout(firstByteTimeoutMs, () => socket.destroy());
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

/** Serves on the port or the next free one: HTTP, or with credentials HTTPS (and HTTP only as a redirect to it). */
export async function serve(
  handler: RequestListener,
  { host, port, credentials }: { host: string; port: number; credentials?: Credentials },
): Promise<WebServer> {
  const requests: HttpServer = credentials ? createHttpsServer(credentials, handler) : createHttpServer(handler);
  const listener: NetServer = credentials ? divide(requests, createHttpServer(redirectToHttps)) : requests;
  const sockets = new Set<Socket>();
  listener.on('connection', (socket: Socket) => {
    sockets.add(socket);
    socket.once('close', () => sockets.delete(socket));
  });
  const actualPort = await listenOnFreePort(listener, host, port);
  return {
    port: actualPort,
    requests,
    close: () =>
      new Promise((resolve, reject) => {
        listener.close((error) => (error ? reject(error) : resolve()));
        for (const socket of sockets) socket.destroy();
      }),
  };
}
