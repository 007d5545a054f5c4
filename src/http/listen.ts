import { once } from 'node:events';
import type { AddressInfo, Server } from 'node:net';
import { ConfigurationError } from './configuration-error';

/** How many ports after the first one are tried. */
const attempts = 20;

/**
 * Listens on the port, or on the next free one within twenty, and resolves to the port it got; 0 asks for any. Rejects with
 * a sentence when none is free or the system refuses.
 */
export async function listenOnFreePort(server: Server, host: string, port: number): Promise<number> {
  for (let candidate = port; candidate < port + attempts && candidate <= 65535; candidate++) {
    try {
      server.listen(candidate, host);
      await once(server, 'listening');
      return (server.address() as AddressInfo).port;
    } catch (error) {
      const { code } = error as NodeJS.ErrnoException;
      if (code === 'EACCES') {
        throw new ConfigurationError(
          `The system does not let this user serve on port ${candidate}; choose one from 1024 up: npm start -- --port 3333`,
        );
      }
      if (code !== 'EADDRINUSE') throw error;
    }
  }
  throw new ConfigurationError(
    `Port ${port} and the ${attempts - 1} after it are in use; name another: npm start -- --port 4000`,
  );
}
