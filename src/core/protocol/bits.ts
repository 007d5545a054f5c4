/** Unsigned numbers of up to 24 bits one after the other, most significant bit first. */
export interface BitWriter {
  write(value: number, bits: number): void;
  /** What was written so far, the last byte filled up with zeros. */
  bytes(): Uint8Array;
}

export function createBitWriter(): BitWriter {
  const bytes: number[] = [];
  let used = 8;
  return {
    write(value, bits) {
      let left = bits;
      while (left > 0) {
        if (used === 8) {
          bytes.push(0);
          used = 0;
        }
        const taken = Math.min(left, 8 - used);
        const part = (value >>> (left - taken)) & ((1 << taken) - 1);
        bytes[bytes.length - 1]! |= part << (8 - used - taken);
        used += taken;
        left -= taken;
      }
    },
    bytes: () => Uint8Array.from(bytes),
  };
}

export interface BitReader {
  /** The next number; past the end of the bytes there are zeros, and `ended` is false for good. */
  read(bits: number): number;
  /** Whether everything was read and nothing more: all bytes used, the rest of the last one zero. */
  ended(): boolean;
}

export function createBitReader(bytes: Uint8Array): BitReader {
  let at = 0;
  return {
    read(bits) {
      let value = 0;
      let left = bits;
      while (left > 0) {
        const used = at & 7;
        const taken = Math.min(left, 8 - used);
        const byte = bytes[at >> 3] ?? 0;
        value = (value << taken) | ((byte >> (8 - used - taken)) & ((1 << taken) - 1));
        at += taken;
        left -= taken;
      }
      return value;
    },
    ended() {
      const padding = (8 - (at & 7)) & 7;
      const last = bytes[bytes.length - 1] ?? 0;
      return (at + padding) >> 3 === bytes.length && (last & ((1 << padding) - 1)) === 0;
    },
  };
}
