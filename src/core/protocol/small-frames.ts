/**
 * Parsers for socket.io that put every packet into one WebSocket frame. Pose packets and frames of poses are their bytes and nothing
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

function encodeText({ type, nsp, data, id }: SocketPacket): string {
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

/** The relay's encoder: text alone, its frames of poses are written below socket.io. */
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

/** The relay's decoder: bytes are poses, which are heard below socket.io. Speaks as an event emitter does, because socket.io expects one. */
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
    if (typeof chunk === 'string') this.tell(decodeText(chunk));
  }

  destroy(): void {
    this.listeners = [];
  }

  protected tell(packet: SocketPacket): void {
    for (const listener of this.listeners) listener(packet);
  }
}

class PageDecoder extends RelayDecoder {
  override add(chunk: string | Uint8Array | ArrayBuffer): void {
    if (typeof chunk === 'string') super.add(chunk);
    else this.tell({ type: eventType, nsp: '/', data: [frameEvent, isBytes(chunk) ? chunk : new Uint8Array(chunk)] });
  }
}

export const relayParser = { Encoder: RelayEncoder, Decoder: RelayDecoder };
export const pageParser = { Encoder: PageEncoder, Decoder: PageDecoder };
