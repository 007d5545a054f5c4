import type { IncomingMessage } from 'node:http';
import { isIP } from 'node:net';
import { hostname } from 'node:os';

/** Why a request is not answered. */
export interface SiteRefusal {
  readonly status: 400 | 403 | 421;
  readonly message: string;
}

/** Which names this server goes by, and pages of which sites may use it. */
export interface SitePolicy {
  /**
   * Whether the request asks for this server by one of its names. A page of another site whose name was pointed at this machine
   * (DNS rebinding) asks by that site's name; addresses in digits cannot be pointed anywhere.
   */
  refusalOfHost(request: IncomingMessage): SiteRefusal | null;
  /** Whether the page behind the request is one of ours. Programs that are no browsers name no origin: they need a secret all the same. */
  refusalOfOrigin(request: IncomingMessage): SiteRefusal | null;
}

export interface SitePolicyOptions {
  /** Origins of pages that may use the server; empty: pages of the very address that they speak to. */
  readonly origins: readonly string[];
  /** Names of the server besides those of this machine and of the origins. */
  readonly hosts: readonly string[];
  /** A proxy stands in front and says by X-Forwarded-Proto how its client came. */
  readonly trustProxy: boolean;
}

/** A host's name without its port, dot at the end or brackets, in small letters; null: no host. */
function nameIn(host: string): string | null {
  const url = `http://${host}`;
  if (!/^[\w.[\]:-]+$/.test(host) || !URL.canParse(url)) return null;
  return new URL(url).hostname.replace(/^\[|\]$/g, '').replace(/\.$/, '');
}

/** What browsers say of a request that a page of this origin sent, or a person by themselves. */
const ownFetchSites: readonly unknown[] = [undefined, 'same-origin', 'none'];

export function createSitePolicy({ origins, hosts, trustProxy }: SitePolicyOptions): SitePolicy {
  const machine = hostname().toLowerCase();
  const names = new Set([
    'localhost',
    machine,
    `${machine}.local`,
    ...hosts.map((host) => host.toLowerCase()),
    ...origins.map((origin) => new URL(origin).hostname),
  ]);

  function ownOrigin({ headers, socket }: IncomingMessage): string | null {
    const secure = 'encrypted' in socket || (trustProxy && headers['x-forwarded-proto'] === 'https');
    const address = `${secure ? 'https' : 'http'}://${headers.host}`;
    return headers.host !== undefined && URL.canParse(address) ? new URL(address).origin : null;
  }

  return {
    refusalOfHost({ headers: { host } }) {
      // Browsers always name one; what names none (HTTP/1.0) is a program on its own behalf.
      if (host === undefined) return null;
      const name = nameIn(host);
      if (name === null) return { status: 400, message: 'the Host of this request is no name of a server' };
      if (isIP(name) !== 0 || name.endsWith('.localhost') || names.has(name)) return null;
      return {
        status: 421,
        message: `this server does not go by the name ${name}; THREEPOINT_HOSTS lists the names that it goes by`,
      };
    },
    refusalOfOrigin(request) {
      const { origin, 'sec-fetch-site': site } = request.headers;
      const refused = { status: 403, message: 'this page may not use this server' } as const;
      if (origin === undefined) return ownFetchSites.includes(site) ? null : refused;
      if (!URL.canParse(origin)) return refused;
      const allowed = origins.length > 0 ? origins : [ownOrigin(request)];
      return allowed.includes(new URL(origin).origin) ? null : refused;
    },
  };
}
