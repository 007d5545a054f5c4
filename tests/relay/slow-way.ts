import { once } from 'node:events';
import type { AddressInfo } from 'node:net';
import { connect, createServer, type Socket } from 'node:net';

/**
 * A way to a server that is as bad as one likes. In order and without losses, as TCP is; what a loss costs is a delay.
 */
export async function createSlowWay(port: number, delayMs: () => number = () => 0) {
  const sockets = new Set<Socket>();
  let closed = false;
  let reopenedAt = 0;
  let acceptedAt: number | null = null;

  function forward(from: Socket, to: Socket): void {
    let last = 0;
    from.on('data', (chunk) => {
      last = Math.max(last, performance.now() + delayMs());
      const wait = last - performance.now();
      if (wait < 0.5) to.write(chunk);
      else setTimeout(() => to.writable && to.write(chunk), wait);
    });
    from.on('error', () => to.destroy());
    from.on('close', () => {
      sockets.delete(from);
      to.destroy();
    });
  }

  const server = createServer((client) => {
    if (closed) {
      client.destroy();
      return;
    }
    if (reopenedAt > 0) acceptedAt ??= performance.now();
    const onward = connect(port, '127.0.0.1');
    for (const socket of [client, onward]) {
      socket.setNoDelay(true);
      sockets.add(socket);
    }
    forward(client, onward);
    forward(onward, client);
  });
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  return {
    url: `http://127.0.0.1:${(server.address() as AddressInfo).port}`,
    /** Ends all connections and takes no others. */
    cut() {
      closed = true;
      for (const socket of sockets) socket.destroy();
    },
    reopen() {
      closed = false;
      reopenedAt = performance.now();
      acceptedAt = null;
    },
    /** When the first connection since came through [ms]. */
    get acceptedAt() {
      return acceptedAt;
    },
    async close() {
      for (const socket of sockets) socket.destroy();
      server.close();
      await once(server, 'close');
    },
  };
}
