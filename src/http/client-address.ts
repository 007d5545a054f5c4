import type { IncomingMessage } from 'node:http';
import { BlockList, isIP, isIPv4, SocketAddress } from 'node:net';
import { HttpError } from './http-error';

/** The normalised address of a client. Every limit of the server counts by `network`. */
export interface ClientAddress {
  /** An IPv4 address, IPv4-mapped IPv6 included, or an IPv6 address in its shortest form without a zone. */
  readonly text: string;
  /** The IPv4 address, or the /64 of the IPv6 address: one subscriber has at least a /64 to draw addresses from. */
  readonly network: string;
  /** Whether the client is a program on this machine. */
  readonly isLoopback: boolean;
}

/** An address as proxies write it: IPv6 in brackets with or without a port, IPv4 with a port. */
const enclosed = /^\[([^[\]]+)\](?::(\d{1,5}))?$/;
const ipv4WithPort = /^([\d.]+):(\d{1,5})$/;
const highestPort = 65535;

const loopback = new BlockList();
loopback.addSubnet('127.0.0.0', 8);
loopback.addAddress('::1', 'ipv6');

const shortestForm = (address: string): string => new SocketAddress({ address, family: 'ipv6' }).address;

/** The /64 of an IPv6 address in its shortest form. */
function networkOf(ipv6: string): string {
  const [before = [], after = []] = ipv6.split('::').map((half) => half.split(':').filter(Boolean));
  const groups = [...before, ...Array<string>(8 - before.length - after.length).fill('0'), ...after];
  return `${shortestForm(`${groups.slice(0, 4).join(':')}::`)}/64`;
}

/** Returns the normalised address, or null where the text is no IP address. Ports, brackets and zones are dropped. */
export function parseClientAddress(text: string): ClientAddress | null {
  const [, address = text, port = '0'] = enclosed.exec(text) ?? ipv4WithPort.exec(text) ?? [];
  if (isIP(address) === 0 || Number(port) > highestPort) return null;
  const ipv6 = isIPv4(address) ? `::ffff:${address}` : shortestForm(address.replace(/%.*$/, ''));
  const ipv4 = ipv6.replace(/^::ffff:/, '');
  if (isIPv4(ipv4)) return { text: ipv4, network: ipv4, isLoopback: loopback.check(ipv4) };
  return { text: ipv6, network: networkOf(ipv6), isLoopback: loopback.check(ipv6, 'ipv6') };
}

/**
 * Returns the address of the client behind a request: with a trusted proxy in front the last entry of X-Forwarded-For,
 * which that proxy wrote, else the other end of the connection. Null where that is no address, or where the connection
 * is closed.
 */
export function findClientAddress({ headers, socket }: IncomingMessage, trustProxy: boolean): ClientAddress | null {
  const forwarded = trustProxy ? headers['x-forwarded-for'] : undefined;
  if (forwarded === undefined) return parseClientAddress(socket.remoteAddress ?? '');
  return parseClientAddress(String(forwarded).split(',').at(-1)?.trim() ?? '');
}

/** Returns the address for a limit that counts it. Throws an HttpError 400 where there is none. */
export function requiredAddress(address: ClientAddress | null): ClientAddress {
  if (address) return address;
  throw new HttpError(
    400,
    'the last entry of X-Forwarded-For is not an IP address; correct the configuration of the proxy',
  );
}

/**
 * Returns the address of the client behind a request, for a limit that counts it. Throws an HttpError 400 where there
 * is none.
 */
export const clientAddressOf = (request: IncomingMessage, trustProxy: boolean): ClientAddress =>
  requiredAddress(findClientAddress(request, trustProxy));
