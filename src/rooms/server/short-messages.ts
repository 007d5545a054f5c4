/** What ws keeps of a connection while it reads it. */
interface Receiver {
  write(chunk: Buffer): boolean;
  /** 0: the next byte begins a frame. */
  readonly _state?: number;
  /** Bytes of a frame that is not there in full. */
  readonly _bufferedBytes?: number;
  /** Not 0: a message is under way whose end comes in another frame. */
  readonly _fragmented?: number;
}

/** A WebSocket of ws. */
export interface ReceivingWebSocket {
  // reason: private in ws 8, and the one place where bytes from the wire pass that are not frames yet. Nothing public replaces it: no option names
  // a receiver of one's own, though its class is exported; `allowSynchronousEvents` (on) only spares turns of the event loop; and a Duplex around the
  // socket, which `handleUpgrade` takes, is one more stream for every byte and has to follow all frames by itself to know where one begins.
  readonly _receiver?: Receiver;
}

/** FIN and the opcode of binary messages; a longer length than this has bytes of its own. */
const wholeBinary = 0x82;
const longestShort = 125;
const headBytes = 2;
const maskBytes = 4;

/** Tells `listener` the short binary messages that a chunk begins with, unmasked in place, and returns where they end. */
function takeLeading(chunk: Buffer, listener: (bytes: Uint8Array) => void): number {
  let at = 0;
  while (chunk.length - at >= headBytes + maskBytes && chunk[at] === wholeBinary) {
    const length = chunk[at + 1]! - 0x80;
    const begin = at + headBytes + maskBytes;
    const end = begin + length;
    if (length < 0 || length > longestShort || end > chunk.length) break;
    for (let i = 0; i < length; i++) chunk[begin + i]! ^= chunk[begin - maskBytes + (i & 3)]!;
    listener(chunk.subarray(begin, end));
    at = end;
  }
  return at;
}

/**
 * Poses arrive as one short binary frame each, mostly alone in their chunk: those are told at once, and ws reads everything else, from
 * the first byte that is none of them. Its state machine takes as long for such a frame as the room does for the pose in it. A ws that keeps its
 * state otherwise reads everything by itself.
 */
export function takeShortMessages({ _receiver }: ReceivingWebSocket, listener: (bytes: Uint8Array) => void): void {
  if (!_receiver) return;
  const read = _receiver.write;
  _receiver.write = (chunk) => {
    const { _state, _bufferedBytes, _fragmented } = _receiver;
    const between = _state === 0 && _bufferedBytes === 0 && _fragmented === 0;
    const taken = between ? takeLeading(chunk, listener) : 0;
    if (taken === chunk.length && taken > 0) return true;
    return read.call(_receiver, taken > 0 ? chunk.subarray(taken) : chunk);
  };
}
