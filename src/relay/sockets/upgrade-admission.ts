import type { IncomingMessage } from 'node:http';
import { clientAddressOf, createSitePolicy, createSlotCounter, HttpError } from 'threepoint-http';
import type { RelayContext } from '../relay-context';

/** Returns why a request is not one for a WebSocket of the relay's protocol; null: it is one. */
function protocolErrorOf({ method, headers }: IncomingMessage, query: URLSearchParams): HttpError | null {
  if (
    method !== 'GET' ||
    headers.upgrade?.toLowerCase() !== 'websocket' ||
    !/^[+/0-9A-Za-z]{22}==$/.test(headers['sec-websocket-key'] ?? '')
  ) {
    return new HttpError(400, 'this is no request for a WebSocket');
  }
  if (headers['sec-websocket-version'] !== '13') {
    return new HttpError(426, 'this server supports version 13 of WebSocket alone', {
      headers: { 'sec-websocket-version': '13' },
    });
  }
  if (query.get('EIO') !== '4' || query.get('transport') !== 'websocket' || query.has('sid')) {
    return new HttpError(400, 'this server supports Engine.IO 4 over WebSockets alone');
  }
  return null;
}

/**
 * Returns what admits a request to the WebSockets of a relay: it checks protocol, host and origin, takes a slot of the
 * client's address and returns the function that releases it. It throws an HttpError that states why a request is
 * refused.
 */
export function createUpgradeAdmission({
  configuration,
  log,
  metrics,
}: RelayContext): (request: IncomingMessage, query: URLSearchParams) => () => void {
  const addresses = createSlotCounter(configuration.connectionsPerAddress);
  const site = createSitePolicy(configuration);
  return (request, query) => {
    const error = protocolErrorOf(request, query);
    if (error) throw error;
    const rejection = site.checkHost(request) ?? site.checkOrigin(request);
    if (rejection) {
      metrics.kicked('origin');
      log.warn({ origin: request.headers.origin, host: request.headers.host }, 'origin refused');
      throw new HttpError(rejection.status, rejection.message);
    }
    const { network } = clientAddressOf(request, configuration.trustProxy);
    if (!addresses.acquire(network)) {
      metrics.kicked('connections');
      throw new HttpError(429, `this address has the most connections allowed, ${configuration.connectionsPerAddress}`);
    }
    return () => addresses.release(network);
  };
}
