import type { IncomingMessage } from 'node:http';

/** Where a request goes. */
export interface Target {
  /** As sent: begins with one slash, percent signs and dots untouched. */
  readonly path: string;
  readonly query: URLSearchParams;
}

/** What an absolute request target begins with; a proxy sends such. */
const absolute = /^https?:\/\/[^/?#]+/i;
/** Visible ASCII but the backslash, which some clients read as a slash. */
const wellFormed = /^\/(?!\/)[!-[\]-~]*$/;

/** Returns the target of a request line, or null where it is not well formed. Never throws. */
export function targetOf(url: string | undefined): Target | null {
  const origin = absolute.exec(url ?? '')?.[0];
  if (origin !== undefined && !URL.canParse(origin)) return null;
  const relative = (url ?? '').slice(origin?.length ?? 0).replace(/#.*$/s, '') || '/';
  const cut = relative.indexOf('?');
  const path = cut < 0 ? relative : relative.slice(0, cut) || '/';
  if (!wellFormed.test(path)) return null;
  try {
    decodeURIComponent(path);
  } catch (error) {
    if (error instanceof URIError) return null;
    throw error;
  }
  return { path, query: new URLSearchParams(cut < 0 ? '' : relative.slice(cut)) };
}

/**
 * Returns what is wrong with the names that a request gives its server, or null. A request has one Host line (HTTP/1.0: at most one), and an
 * absolute target names the same authority. Servers and proxies that choose differently between two names can be played against each other.
 */
export function complaintAboutHost({ url = '', headersDistinct, httpVersion }: IncomingMessage): string | null {
  const { host: hosts = [] } = headersDistinct;
  const [host] = hosts;
  if (hosts.length > 1) return 'a request names its host once';
  if (host === undefined && httpVersion === '1.1') return 'a request names its host';
  const named = absolute.exec(url)?.[0];
  // A target that cannot be parsed is refused where it is read.
  if (named === undefined || !URL.canParse(named)) return null;
  const { protocol, origin } = new URL(named);
  const expected = `${protocol}//${host}`;
  const isSame = host !== undefined && URL.canParse(expected) && new URL(expected).origin === origin;
  return isSame && !named.includes('@') ? null : 'the target of this request names another server than its Host';
}
