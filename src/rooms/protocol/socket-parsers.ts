import { isObject } from 'threepoint/core';

/**
 * Parsers for socket.io that put every packet into one WebSocket frame. Pose packets and frames of poses are sent as
 * their bytes alone; all other packets are text: the digit of the packet's type and JSON. Anything else throws, and
 * socket.io closes the connection.
 */

/** A packet of socket.io. Types: 0 connect, 1 disconnect, 2 event, 3 acknowledgement, 4 error. */
export interface SocketPacket {
  readonly type: number;
  readonly nsp: string;
  // biome-ignore lint/suspicious/noExplicitAny: reason: packets of socket.io carry arbitrary data.
  readonly data?: any;
  readonly id?: number;
}

/** The two events that are bytes alone: poses of a page to the relay, and frames of poses from the relay. */
export const poseEvent = 'pose';
export const frameEvent = 'frame';
/** The event of all control messages. */
export const messageEvent = 'message';

const eventType = 2;
const acknowledgementType = 3;

type Listener = (packet: SocketPacket) => void;

const isBytes = (value: unknown): value is Uint8Array => value instanceof Uint8Array;

function encodeText({ type, nsp, data, id }: SocketPacket): string {
  const parts = id !== undefined ? [nsp, data, id] : data !== undefined ? [nsp, data] : [nsp];
  return `${type}${JSON.stringify(parts)}`;
}

/** Events that socket.io or Node's emitter raise themselves: a packet with such a name would run their listeners. */
const reservedEvents: ReadonlySet<unknown> = new Set([
  ...['connect', 'connect_error', 'disconnect', 'disconnecting'],
  ...['error', 'newListener', 'removeListener'],
]);

const isEvent = (value: unknown): boolean =>
  Array.isArray(value) && typeof value[0] === 'string' && !reservedEvents.has(value[0]);

/**
 * Returns whether a packet may carry some data, by the digit of its type. socket.io relies on its parser for this
 * check: invalid data can crash the process.
 */
const mayCarry: readonly ((data: unknown) => boolean)[] = [
  (data) => data === undefined || isObject(data),
  (data) => data === undefined,
  isEvent,
  Array.isArray,
  (data) => typeof data === 'string' || isObject(data),
];

/** Returns whether a packet of this type may have this id: an acknowledgement must have one, an event may. */
const mayHaveId = (type: number, id: unknown): boolean => {
  if (id === undefined) return type !== acknowledgementType;
  const isNumbered = type === eventType || type === acknowledgementType;
  return isNumbered && Number.isSafeInteger(id) && (id as number) >= 0;
};

function decodeText(text: string): SocketPacket {
  const type = text.charCodeAt(0) - 48;
  const parts: unknown = JSON.parse(text.slice(1));
  if (!Array.isArray(parts) || parts.length > 3) throw new Error('the packet is malformed');
  const [nsp, data, id] = parts as [unknown, unknown, unknown];
  if (typeof nsp !== 'string' || nsp.length > 60) throw new Error('the namespace is invalid');
  if (!mayCarry[type]?.(data)) throw new Error('the data does not fit the packet type');
  if (!mayHaveId(type, id)) throw new Error('the id is invalid');
  return { type, nsp, data, ...(id !== undefined && { id: id as number }) };
}

/** The relay's encoder, for text alone: frames of poses pass it by. */
class RelayEncoder {
  encode(packet: SocketPacket): (string | Uint8Array)[] {
    return [encodeText(packet)];
  }
}

class PageEncoder {
  encode(packet: SocketPacket): (string | Uint8Array)[] {
    const [event, payload] = Array.isArray(packet.data) ? packet.data : [];
    return [event === poseEvent && isBytes(payload) ? payload : encodeText(packet)];
  }
}

/**
 * The relay's decoder, for text alone: poses pass it by. It has the methods of an event emitter that
 * socket.io calls.
 */
class RelayDecoder {
  private listeners: Listener[] = [];

  on(_event: 'decoded', listener: Listener): this {
    this.listeners.push(listener);
    return this;
  }

  off(_event: 'decoded', listener: Listener): this {
    this.listeners = this.listeners.filter((other) => other !== listener);
    return this;
  }

  removeListener(event: 'decoded', listener: Listener): this {
    return this.off(event, listener);
  }

  add(chunk: string | Uint8Array | ArrayBuffer): void {
    if (typeof chunk === 'string') this.notify(decodeText(chunk));
  }

  destroy(): void {
    this.listeners = [];
  }

  protected notify(packet: SocketPacket): void {
    for (const listener of this.listeners) listener(packet);
  }
}

class PageDecoder extends RelayDecoder {
  override add(chunk: string | Uint8Array | ArrayBuffer): void {
    if (typeof chunk === 'string') super.add(chunk);
    else this.notify({ type: eventType, nsp: '/', data: [frameEvent, isBytes(chunk) ? chunk : new Uint8Array(chunk)] });
  }
}

export const relayParser = { Encoder: RelayEncoder, Decoder: RelayDecoder };
export const pageParser = { Encoder: PageEncoder, Decoder: PageDecoder };
