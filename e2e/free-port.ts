import { once } from 'node:events';
import { createServer } from 'node:net';

/** Returns a TCP port of loopback that was free when it was probed. */
export async function freePort(): Promise<number> {
  const probing = createServer().listen(0, '127.0.0.1');
  await once(probing, 'listening');
  const address = probing.address();
  probing.close();
  await once(probing, 'close');
  if (address === null || typeof address === 'string') throw new Error('no port is free');
  return address.port;
}
