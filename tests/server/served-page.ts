import type { RequestListener } from 'node:http';
import { createPageHandler, type PageOptions } from '../../server/page-handler';
import { serve } from '../http/serve';

interface ServedPageOptions extends PageOptions {
  /** Default: any free port. */
  readonly port?: number;
  /** Receives every request before the page answers it. */
  readonly before?: RequestListener;
}

/** Serves the page in this folder on loopback, as `npm start` does. */
export function servePage(folder: string, { port = 0, before, ...options }: ServedPageOptions = {}) {
  const page = createPageHandler(folder, options);
  const listener: RequestListener = (request, response) => {
    before?.(request, response);
    page(request, response);
  };
  return serve(listener, { port });
}
