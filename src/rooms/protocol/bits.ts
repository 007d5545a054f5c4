/** Unsigned numbers of up to 24 bits one after the other, most significant bit first. */
export interface BitWriter {
  write(value: number, bits: number): void;
  /** What was written since the last `clear`, the last byte filled up with zeros; a copy. */
  bytes(): Uint8Array;
  /** Begins anew, in the same memory. */
  clear(): void;
}

/** Room for as many bytes as a pose packet has; longer ones make more. */
const firstCapacity = 64;

class BufferedBitWriter implements BitWriter {
  private buffer = new Uint8Array(firstCapacity);
  /** Bits written. */
  private at = 0;

  write(value: number, bits: number): void {
    if ((this.at + bits + 7) >> 3 > this.buffer.length) this.grow();
    let left = bits;
    while (left > 0) {
      const used = this.at & 7;
      const taken = Math.min(left, 8 - used);
      const part = (value >>> (left - taken)) & ((1 << taken) - 1);
      const byte = this.at >> 3;
      const before = used === 0 ? 0 : this.buffer[byte]!;
      this.buffer[byte] = before | (part << (8 - used - taken));
      this.at += taken;
      left -= taken;
    }
  }

  bytes(): Uint8Array {
    return this.buffer.slice(0, (this.at + 7) >> 3);
  }

  clear(): void {
    this.at = 0;
  }

  private grow(): void {
    const longer = new Uint8Array(2 * this.buffer.length);
    longer.set(this.buffer);
    this.buffer = longer;
  }
}

export const createBitWriter = (): BitWriter => new BufferedBitWriter();

export interface BitReader {
  /** The next number; past the end of the bytes there are zeros, and `ended` is false for good. */
  read(bits: number): number;
  /** Whether everything was read and nothing more: all bytes used, the rest of the last one zero. */
  ended(): boolean;
  /** Begins with other bytes. */
  open(bytes: Uint8Array): void;
}

class ByteReader implements BitReader {
  private at = 0;

  constructor(private bytes: Uint8Array) {}

  open(bytes: Uint8Array): void {
    this.bytes = bytes;
    this.at = 0;
  }

  read(bits: number): number {
    let value = 0;
    let left = bits;
    while (left > 0) {
      const used = this.at & 7;
      const taken = Math.min(left, 8 - used);
      const byte = this.bytes[this.at >> 3] ?? 0;
      value = (value << taken) | ((byte >> (8 - used - taken)) & ((1 << taken) - 1));
      this.at += taken;
      left -= taken;
    }
    return value;
  }

  ended(): boolean {
    const { at, bytes } = this;
    const padding = (8 - (at & 7)) & 7;
    const last = bytes[bytes.length - 1] ?? 0;
    return (at + padding) >> 3 === bytes.length && (last & ((1 << padding) - 1)) === 0;
  }
}

export const createBitReader = (bytes: Uint8Array): BitReader => new ByteReader(bytes);
