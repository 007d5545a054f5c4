import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import { onTestFinished } from 'vitest';
import { type AttachRoomsOptions, attachRooms } from '../../src/relay/attach-rooms';

/** Starts a node:http server of another project with rooms attached. It closes when the test ends. */
export async function servedRooms(options: AttachRoomsOptions = {}) {
  const server = createServer((request, response) => response.end(`mine: ${request.url}`));
  const rooms = attachRooms(server, { logLevel: 'silent', ...options });
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  onTestFinished(async () => {
    await rooms.close();
    server.closeAllConnections();
    await new Promise((resolve) => server.close(resolve));
  });
  return { rooms, server, url: `http://127.0.0.1:${(server.address() as AddressInfo).port}` };
}
