import type { RequestListener } from 'node:http';
import { prepareServer } from 'threepoint-http';

type Options = Parameters<typeof prepareServer>[1];

/** Serves on loopback and any free port, unless stated. */
export const serve = (
  listener: RequestListener,
  { host = '127.0.0.1', port = 0, ...options }: Options & { readonly host?: string; readonly port?: number } = {},
) => prepareServer(listener, options).listen({ host, port });
