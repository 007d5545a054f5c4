import type { IncomingMessage, RequestListener } from 'node:http';
import { ValidationError } from 'threepoint/core';
import { HttpError, internalError } from './http-error';
import { readWholeBody } from './request-body';
import { parseRequestTarget } from './request-target';
import { errorResponse, type HttpResponse, sendError, sendResponse } from './response';
import { createSitePolicy, type SitePolicy } from './site-policy';

/** A request to a route, with its body. */
export interface Call {
  readonly request: IncomingMessage;
  /** The path segments by the route's ":names"; not validated. */
  readonly names: Readonly<Record<string, string>>;
  readonly query: URLSearchParams;
  /** The body; empty for a route whose `bodyLimit` is 0. */
  readonly body: Uint8Array<ArrayBuffer>;
}

export interface Route<Access extends string = string> {
  readonly method: 'GET' | 'POST' | 'PUT' | 'DELETE';
  /** The path; ":name" matches one segment. */
  readonly path: string;
  /** Who may call the route; the service's `admit` checks it. */
  readonly access: Access;
  /** The longest JSON body [bytes]; 0: the router does not read the body. */
  readonly bodyLimit: number;
  handle(call: Call): HttpResponse | Promise<HttpResponse>;
}

/** A set of routes with common access rules and errors. */
export interface Service<Access extends string = string> {
  readonly routes: readonly Route<Access>[];
  /**
   * Called before the body is read. Returns the answer to a request that may not use the route, or throws an HttpError;
   * undefined: the request may use it.
   */
  admit(route: Route<Access>, call: Omit<Call, 'body'>): HttpResponse | undefined | Promise<HttpResponse | undefined>;
  /** Called with each internal error; the client receives status 500 without details. */
  onError(error: unknown): void;
}

/** The deepest nesting of a JSON body. Stored data needs less, and recursion would overflow the stack at 100,000. */
const deepest = 64;

function depthExceeds(value: unknown, limit: number): boolean {
  if (typeof value !== 'object' || value === null) return false;
  return limit === 0 || Object.values(value).some((inner) => depthExceeds(inner, limit - 1));
}

export const textOf = ({ body }: Pick<Call, 'body'>): string => Buffer.from(body.buffer).toString('utf8');

/** Returns the parsed JSON body. Throws an HttpError 400 if it is not JSON or nested too deeply. */
export function jsonOf(call: Pick<Call, 'body'>): unknown {
  let value: unknown;
  try {
    value = JSON.parse(textOf(call));
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    throw new HttpError(400, `the body is not JSON: ${error.message}`);
  }
  if (depthExceeds(value, deepest)) throw new HttpError(400, `the body is nested more than ${deepest} deep`);
  return value;
}

/** Returns what the client receives for an error; null: an internal error. */
export function rejectionOf(error: unknown): HttpError | null {
  if (error instanceof ValidationError) return new HttpError(400, error.message, { field: error.field || null });
  return error instanceof HttpError ? error : null;
}

const segment = '([^/]+)';

function matcherOf<Access extends string>(service: Service<Access>, route: Route<Access>) {
  const names = [...route.path.matchAll(/:(\w+)/g)].map(([, name]) => name as string);
  const pattern = new RegExp(`^${route.path.replace(/:\w+/g, segment)}/?$`);
  return {
    route,
    onError: service.onError,
    /** Returns the named segments; null: the path does not match. */
    match(path: string): Readonly<Record<string, string>> | null {
      const found = pattern.exec(path);
      return found && Object.fromEntries(names.map((name, i) => [name, decodeURIComponent(found[i + 1] as string)]));
    },
    async answer(call: Omit<Call, 'body'>): Promise<HttpResponse> {
      const rejected = await service.admit(route, call);
      if (rejected) return rejected;
      if (route.bodyLimit === 0) return route.handle({ ...call, body: new Uint8Array() });
      if (!/^application\/json(;|$)/i.test(call.request.headers['content-type'] ?? '')) {
        throw new HttpError(415, 'the content type must be application/json');
      }
      return route.handle({ ...call, body: await readWholeBody(call.request, route.bodyLimit) });
    },
    answerTo(error: unknown): HttpResponse {
      const known = rejectionOf(error);
      if (known) return errorResponse(known);
      service.onError(error);
      return errorResponse(internalError());
    },
  };
}

/** The prefix of the services' paths; no file is served below it. */
const api = /^\/api(\/|$)/;

/**
 * Creates the listener for all requests: it dispatches to the routes, and passes other paths to `page`. It never
 * throws. Statuses: 400 for a malformed target, 403 and 421 for other sites (`site`), 404, 405, 413, 415, and 500 for
 * internal errors.
 */
export function createRouter(
  services: readonly Service[],
  page: RequestListener,
  site: SitePolicy = createSitePolicy({ origins: [], hosts: [], trustProxy: false }),
): RequestListener {
  const matchers = services.flatMap((service) => service.routes.map((route) => matcherOf(service, route)));
  return (request, response) => {
    const target = parseRequestTarget(request.url);
    if (!target) {
      sendError(request, response, new HttpError(400, 'this address is not well formed'));
      return;
    }
    const { path, query } = target;
    // Any site may link to the page; only pages of this server may use the API.
    const reading = (request.method === 'GET' || request.method === 'HEAD') && !api.test(path);
    const stranger = site.checkHost(request) ?? (reading ? null : site.checkOrigin(request));
    if (stranger) {
      sendError(request, response, new HttpError(stranger.status, stranger.message));
      return;
    }
    const here = matchers.flatMap((matcher) => {
      const names = matcher.match(path);
      return names ? [{ matcher, names }] : [];
    });
    if (here.length === 0) {
      if (api.test(path)) {
        sendError(request, response, new HttpError(404, 'there is nothing at this address'));
      } else page(request, response);
      return;
    }
    const method = request.method === 'HEAD' ? 'GET' : request.method;
    const found = here.find(({ matcher }) => matcher.route.method === method);
    if (!found) {
      const allow = [...new Set(here.map(({ matcher }) => matcher.route.method))].join(', ');
      sendError(request, response, new HttpError(405, `this address answers ${allow}`, { headers: { allow } }));
      return;
    }
    const { matcher, names } = found;
    matcher
      .answer({ request, names, query })
      .catch((error: unknown) => matcher.answerTo(error))
      .then((answer) => sendResponse(request, response, answer))
      .catch((error: unknown) => {
        matcher.onError(error);
        response.destroy();
      });
  };
}

/** The listener for a server without a page: answers 404. */
export const noPage: RequestListener = (request, response) =>
  sendError(request, response, new HttpError(404, 'there is nothing at this address'));
