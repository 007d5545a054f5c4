import type { IncomingMessage, RequestListener } from 'node:http';
import { ValidationError } from 'threepoint/core/validation/validation';
import { type Answer, HttpError, json, refusal, sendAnswer } from './answer';
import { wholeBody } from './body';
import { createSitePolicy, type SitePolicy } from './site-policy';
import { targetOf } from './target';

/** A request to a route, its body read. */
export interface Call {
  readonly request: IncomingMessage;
  /** What stands in the address for the route's ":names"; not yet checked. */
  readonly names: Readonly<Record<string, string>>;
  readonly query: URLSearchParams;
  /** Empty for a route that takes none. */
  readonly body: Uint8Array<ArrayBuffer>;
}

/** One line of a service's table. */
export interface Route<Access extends string = string> {
  readonly method: 'GET' | 'POST' | 'PUT' | 'DELETE';
  /** ":name" stands for one segment. */
  readonly path: string;
  /** Who may: what its service's `admit` makes sure of. */
  readonly access: Access;
  /** Longest body of JSON [bytes]; 0: what is sent is not read, unless `handle` does. */
  readonly bodyLimit: number;
  handle(call: Call): Answer | Promise<Answer>;
}

/** Routes that admit and refuse alike. */
export interface Service<Access extends string = string> {
  readonly routes: readonly Route<Access>[];
  /** Throws an HttpError where this request may not; asked before the body is read. */
  admit(route: Route<Access>, call: Omit<Call, 'body'>): void | Promise<void>;
  /** What an error that only this service knows is to the other side; null: a fault of ours. */
  refusalOf(error: unknown): HttpError | null;
  /** Told of faults of ours; the other side hears only that there was one. */
  onFault(error: unknown): void;
}

/** Lists and objects in each other: nothing that is stored needs as many, and code that recurses has no stack for 100,000. */
const deepest = 64;

function depthExceeds(value: unknown, limit: number): boolean {
  if (typeof value !== 'object' || value === null) return false;
  return limit === 0 || Object.values(value).some((inner) => depthExceeds(inner, limit - 1));
}

/** The body as text. */
export const textOf = ({ body }: Pick<Call, 'body'>): string => Buffer.from(body.buffer).toString('utf8');

/** The body's JSON; an HttpError 400 where it is none, or nested beyond reason. */
export function jsonOf(call: Pick<Call, 'body'>): unknown {
  let value: unknown;
  try {
    value = JSON.parse(textOf(call));
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    throw new HttpError(400, `the body is no JSON: ${error.message}`);
  }
  if (depthExceeds(value, deepest)) throw new HttpError(400, `the body is nested more than ${deepest} deep`);
  return value;
}

/** What an error is to the other side; null: a fault of the server. */
export function refusalOf(error: unknown): HttpError | null {
  if (error instanceof ValidationError) return new HttpError(400, error.message, { field: error.field || null });
  return error instanceof HttpError ? error : null;
}

const segment = '([^/]+)';

function matcherOf<Access extends string>(service: Service<Access>, route: Route<Access>) {
  const names = [...route.path.matchAll(/:(\w+)/g)].map(([, name]) => name as string);
  const pattern = new RegExp(`^${route.path.replace(/:\w+/g, segment)}/?$`);
  return {
    route,
    /** The named segments; null: another path. */
    match(path: string): Readonly<Record<string, string>> | null {
      const found = pattern.exec(path);
      return found && Object.fromEntries(names.map((name, i) => [name, decodeURIComponent(found[i + 1] as string)]));
    },
    async answer(call: Omit<Call, 'body'>): Promise<Answer> {
      await service.admit(route, call);
      if (route.bodyLimit === 0) return route.handle({ ...call, body: new Uint8Array() });
      if (!/^application\/json(;|$)/i.test(call.request.headers['content-type'] ?? '')) {
        throw new HttpError(415, 'send application/json');
      }
      return route.handle({ ...call, body: await wholeBody(call.request, route.bodyLimit) });
    },
    answerTo(error: unknown): Answer {
      const known = refusalOf(error) ?? service.refusalOf(error);
      if (known) return refusal(known);
      service.onFault(error);
      return refusal(new HttpError(500, 'the server failed; nothing was stored'));
    },
  };
}

/** The paths of services; below it nothing is a file. */
const api = /^\/api(\/|$)/;

/**
 * The one entry of every request: answers what is a route's, and leaves other paths to `page`. Each request gets an answer and
 * nothing is thrown: 400 for a target that is not well formed, 403 and 421 for other sites (`site`), 404, 405, 413, 415, and 500 for
 * faults of ours.
 */
export function createRouter(
  services: readonly Service[],
  page: RequestListener,
  site: SitePolicy = createSitePolicy({ origins: [], hosts: [], trustProxy: false }),
): RequestListener {
  const matchers = services.flatMap((service) => service.routes.map((route) => matcherOf(service, route)));
  return (request, response) => {
    const target = targetOf(request.url);
    if (!target) {
      sendAnswer(request, response, refusal(new HttpError(400, 'this address is not well formed')));
      return;
    }
    const { path, query } = target;
    // The page itself may be linked to from anywhere; what answers or changes something may be used by our own pages alone.
    const reading = (request.method === 'GET' || request.method === 'HEAD') && !api.test(path);
    const stranger = site.refusalOfHost(request) ?? (reading ? null : site.refusalOfOrigin(request));
    if (stranger) {
      sendAnswer(request, response, refusal(new HttpError(stranger.status, stranger.message)));
      return;
    }
    const here = matchers.flatMap((matcher) => {
      const names = matcher.match(path);
      return names ? [{ matcher, names }] : [];
    });
    if (here.length === 0) {
      if (api.test(path)) {
        sendAnswer(request, response, refusal(new HttpError(404, 'there is nothing at this address')));
      } else page(request, response);
      return;
    }
    const method = request.method === 'HEAD' ? 'GET' : request.method;
    const found = here.find(({ matcher }) => matcher.route.method === method);
    if (!found) {
      const allow = [...new Set(here.map(({ matcher }) => matcher.route.method))].join(', ');
      const answer = refusal(new HttpError(405, `this address answers ${allow}`, { headers: { allow } }));
      sendAnswer(request, response, answer);
      return;
    }
    const { matcher, names } = found;
    matcher
      .answer({ request, names, query })
      .catch((error: unknown) => matcher.answerTo(error))
      .then((answer) => sendAnswer(request, response, answer))
      .catch(() => response.destroy());
  };
}

/** The page for a server that has none. */
export const noPage: RequestListener = (request, response) =>
  sendAnswer(request, response, json({ error: 'there is nothing at this address', field: null }, 404));
