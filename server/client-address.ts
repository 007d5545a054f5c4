import type { IncomingMessage } from 'node:http';

/** Where a request comes from: what the proxy in front says if there is one that we believe, else the other end of the connection. */
export function clientAddress({ headers, socket }: IncomingMessage, trustProxy: boolean): string {
  const forwarded = headers['x-forwarded-for'];
  // The last one is what our own proxy saw; those before it anybody may have made up.
  const last = trustProxy
    ? String(forwarded ?? '')
        .split(',')
        .at(-1)
        ?.trim()
    : '';
  return last || (socket.remoteAddress ?? 'unknown');
}

/** This machine itself. */
export const isLoopback = (address: string): boolean => /^(::ffff:)?127\.|^::1$/.test(address);
