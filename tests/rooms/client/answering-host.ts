import { createServer, type RequestListener, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { onTestFinished } from 'vitest';

/** A host that answers so until the test is over, and the folder of a page on it. */
export async function answeringHost(
  answer: RequestListener,
): Promise<{ readonly server: Server; readonly folder: string }> {
  const server = createServer(answer).listen(0, '127.0.0.1');
  await new Promise((resolve) => server.once('listening', resolve));
  onTestFinished(() => {
    server.closeAllConnections();
    server.close();
  });
  return { server, folder: `http://127.0.0.1:${(server.address() as AddressInfo).port}/threepoint` };
}

/** Gives every request this answer. */
export const says =
  (status: number, body: string): RequestListener =>
  (_, response) =>
    response.writeHead(status).end(body);
