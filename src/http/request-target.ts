import type { IncomingMessage } from 'node:http';

interface RequestTarget {
  /** The path as sent: it begins with one slash; percent signs and dots are not decoded. */
  readonly path: string;
  /** The path with its percent signs decoded. */
  readonly decodedPath: string;
  readonly query: URLSearchParams;
}

/** The prefix of an absolute request target, as proxies send it. */
const absolute = /^https?:\/\/[^/?#]+/i;
/** Visible ASCII without the backslash, which some clients read as a slash. */
const wellFormed = /^\/(?!\/)[!-[\]-~]*$/;

/** Returns the text with its percent signs decoded, or null where they encode no text. */
function decoded(text: string): string | null {
  try {
    return decodeURIComponent(text);
  } catch {
    // reason: decodeURIComponent throws nothing but a URIError, and null is the result for it
    return null;
  }
}

/** Returns the target of a request line, or null where it is not well formed. Never throws. */
export function parseRequestTarget(url: string | undefined): RequestTarget | null {
  const origin = absolute.exec(url ?? '')?.[0];
  if (origin !== undefined && !URL.canParse(origin)) return null;
  const relative = (url ?? '').slice(origin?.length ?? 0).replace(/#.*$/s, '') || '/';
  const cut = relative.indexOf('?');
  const path = cut < 0 ? relative : relative.slice(0, cut) || '/';
  if (!wellFormed.test(path)) return null;
  const decodedPath = decoded(path);
  if (decodedPath === null) return null;
  return { path, decodedPath, query: new URLSearchParams(cut < 0 ? '' : relative.slice(cut)) };
}

/**
 * Returns what is wrong with the host of a request, or null. A request has one Host header (HTTP/1.0: at most one), and
 * an absolute target names the same authority. With two names a proxy and a server could route differently.
 */
export function hostProblem({ url = '', headersDistinct, httpVersion }: IncomingMessage): string | null {
  const { host: hosts = [] } = headersDistinct;
  const [host] = hosts;
  if (hosts.length > 1) return 'the request has more than one Host header';
  if (host === undefined && httpVersion === '1.1') return 'the request has no Host header';
  const named = absolute.exec(url)?.[0];
  // The reader of the target refuses one that cannot be parsed.
  if (named === undefined || !URL.canParse(named)) return null;
  const { protocol, origin } = new URL(named);
  const expected = `${protocol}//${host}`;
  const isSame = host !== undefined && URL.canParse(expected) && new URL(expected).origin === origin;
  return isSame && !named.includes('@') ? null : 'the request target and the Host header name different servers';
}
