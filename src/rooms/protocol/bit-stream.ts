/** Initial capacity: the bytes of a pose packet. */
const firstCapacity = 64;

/** Writes unsigned numbers of up to 24 bits, most significant bit first. */
export class BitWriter {
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

  /** Returns a copy of the bytes since the last `clear`; the last byte is padded with zeros. */
  bytes(): Uint8Array {
    return this.buffer.slice(0, (this.at + 7) >> 3);
  }

  /** Discards what was written, and reuses the buffer. */
  clear(): void {
    this.at = 0;
  }

  private grow(): void {
    const longer = new Uint8Array(2 * this.buffer.length);
    longer.set(this.buffer);
    this.buffer = longer;
  }
}

/** Reads unsigned numbers that a BitWriter has written. */
export class BitReader {
  private at = 0;

  constructor(private bytes: Uint8Array) {}

  /** Starts reading other bytes. */
  open(bytes: Uint8Array): void {
    this.bytes = bytes;
    this.at = 0;
  }

  /** Returns the next number. Past the end it reads zeros, and `ended` stays false. */
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

  /** Returns whether exactly all bytes were read, and the padding is zero. */
  ended(): boolean {
    const { at, bytes } = this;
    const padding = (8 - (at & 7)) & 7;
    const last = bytes[bytes.length - 1] ?? 0;
    return (at + padding) >> 3 === bytes.length && (last & ((1 << padding) - 1)) === 0;
  }
}
