import type { IncomingMessage } from 'node:http';
import { isIP } from 'node:net';
import { hostname } from 'node:os';

interface SiteRejection {
  readonly status: 400 | 403 | 421;
  readonly message: string;
}

/** Checks the host and the origin of requests. */
export interface SitePolicy {
  /**
   * Returns why the request's Host is not a name of this server; null: it is. This blocks DNS rebinding, in which
   * another site's name points at this machine. IP addresses are allowed, because they cannot be rebound.
   */
  checkHost(request: IncomingMessage): SiteRejection | null;
  /**
   * Returns why the request's origin may not use the server; null: it may. Programs other than browsers send no origin;
   * they need a secret.
   */
  checkOrigin(request: IncomingMessage): SiteRejection | null;
}

export interface SitePolicyOptions {
  /** Origins of pages that may use the server; empty: the server's own origin. */
  readonly origins: readonly string[];
  /** Further names of the server, beyond those of this machine and of the origins; 'any': the Host is not checked. */
  readonly hosts: readonly string[] | 'any';
  /** Whether a proxy in front sets X-Forwarded-Proto. */
  readonly trustProxy: boolean;
}

/** Returns a host's name in lower case, without port, trailing dot and brackets; null: not a host. */
function nameIn(host: string): string | null {
  const url = `http://${host}`;
  if (!/^[\w.[\]:-]+$/.test(host) || !URL.canParse(url)) return null;
  return new URL(url).hostname.replace(/^\[|\]$/g, '').replace(/\.$/, '');
}

/** Values of Sec-Fetch-Site for requests by a page of this origin or by the user. */
const ownFetchSites: readonly unknown[] = [undefined, 'same-origin', 'none'];

export function createSitePolicy({ origins, hosts, trustProxy }: SitePolicyOptions): SitePolicy {
  const machine = hostname().toLowerCase();
  const names = new Set([
    'localhost',
    machine,
    `${machine}.local`,
    ...(hosts === 'any' ? [] : hosts.map((host) => host.toLowerCase())),
    ...origins.map((origin) => new URL(origin).hostname),
  ]);

  function ownOrigin({ headers, socket }: IncomingMessage): string | null {
    const secure = 'encrypted' in socket || (trustProxy && headers['x-forwarded-proto'] === 'https');
    const address = `${secure ? 'https' : 'http'}://${headers.host}`;
    return headers.host !== undefined && URL.canParse(address) ? new URL(address).origin : null;
  }

  return {
    checkHost({ headers: { host } }) {
      // Browsers always send Host; a request without one (HTTP/1.0) comes from another program.
      if (host === undefined || hosts === 'any') return null;
      const name = nameIn(host);
      if (name === null) return { status: 400, message: 'the Host of this request is not a valid host name' };
      if (isIP(name) !== 0 || name.endsWith('.localhost') || names.has(name)) return null;
      return {
        status: 421,
        message: `this server does not accept the name ${name}; add it to THREEPOINT_HOSTS`,
      };
    },
    checkOrigin(request) {
      const { origin, 'sec-fetch-site': site } = request.headers;
      const rejected = { status: 403, message: 'this page may not use this server' } as const;
      if (origin === undefined) return ownFetchSites.includes(site) ? null : rejected;
      if (!URL.canParse(origin)) return rejected;
      const allowed = origins.length > 0 ? origins : [ownOrigin(request)];
      return allowed.includes(new URL(origin).origin) ? null : rejected;
    },
  };
}
