/**
 * A parser for socket.io that puts every packet into one WebSocket frame. Pose packets and frames of poses are their bytes and nothing
 * else; all other packets are text: the digit of the packet's type and JSON. What is not like that throws, and socket.io closes
 * the connection.
 */

/** A packet of socket.io. Types: 0 connect, 1 disconnect, 2 event, 3 acknowledgement, 4 error. */
export interface SocketPacket {
  readonly type: number;
  readonly nsp: string;
  // biome-ignore lint/suspicious/noExplicitAny: reason: the packets of socket.io carry what their sender put into them.
  readonly data?: any;
  readonly id?: number;
}

/** Names of the two events that are bytes alone: of one avatar to the relay, of a room from it. */
export const poseEvent = 'pose';
export const frameEvent = 'frame';
/** The event of all control messages. */
export const messageEvent = 'message';

const eventType = 2;

type Listener = (packet: SocketPacket) => void;

const isBytes = (value: unknown): value is Uint8Array => value instanceof Uint8Array;

function encodePacket(packet: SocketPacket, bytesEvent: string): string | Uint8Array {
  const { type, nsp, data, id } = packet;
  const [event, payload] = Array.isArray(data) ? data : [];
  // A cluster's adapter turns events with bytes into another type of packet.
  if (nsp === '/' && event === bytesEvent && isBytes(payload)) return payload;
  const parts = id !== undefined ? [nsp, data, id] : data !== undefined ? [nsp, data] : [nsp];
  return `${type}${JSON.stringify(parts)}`;
}

function decodeText(text: string): SocketPacket {
  const type = text.charCodeAt(0) - 48;
  const parts: unknown = JSON.parse(text.slice(1));
  if (!(type >= 0 && type <= 4) || !Array.isArray(parts) || parts.length > 3) throw new Error('no packet');
  const [nsp, data, id] = parts as [unknown, unknown, unknown];
  if (typeof nsp !== 'string' || nsp.length > 60) throw new Error('no namespace');
  if (id !== undefined && !(Number.isSafeInteger(id) && (id as number) >= 0)) throw new Error('no id');
  if (type === eventType && !(Array.isArray(data) && typeof data[0] === 'string')) throw new Error('no event');
  if (type === 3 && !Array.isArray(data)) throw new Error('no acknowledgement');
  return { type, nsp, data, ...(id !== undefined && { id: id as number }) };
}

/** The parser of one end: which event its incoming bytes are, and which its outgoing ones. */
function parserOf(incoming: string, outgoing: string) {
  class Encoder {
    encode(packet: SocketPacket): (string | Uint8Array)[] {
      return [encodePacket(packet, outgoing)];
    }
  }

  /** Speaks as an event emitter does, because socket.io expects one. */
  class Decoder {
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
      const packet =
        typeof chunk === 'string'
          ? decodeText(chunk)
          : { type: eventType, nsp: '/', data: [incoming, isBytes(chunk) ? chunk : new Uint8Array(chunk)] };
      for (const listener of this.listeners) listener(packet);
    }

    destroy(): void {
      this.listeners = [];
    }
  }

  return { Encoder, Decoder };
}

export const relayParser = parserOf(poseEvent, frameEvent);
export const pageParser = parserOf(frameEvent, poseEvent);
