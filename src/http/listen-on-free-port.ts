import { once } from 'node:events';
import type { AddressInfo, Server } from 'node:net';
import { ConfigurationError } from './configuration-error';

/** The number of ports that are tried. */
const attempts = 20;

/**
 * Listens on the port, or on the next free one of twenty, and resolves to that port; 0: any. Rejects with a
 * ConfigurationError if none is free or the system refuses.
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
          `This user may not listen on port ${candidate}. Choose one from 1024 up: npm start -- --port 3333`,
        );
      }
      if (code !== 'EADDRINUSE') throw error;
    }
  }
  throw new ConfigurationError(
    `Port ${port} and the ${attempts - 1} after it are in use. Choose another: npm start -- --port 4000`,
  );
}
