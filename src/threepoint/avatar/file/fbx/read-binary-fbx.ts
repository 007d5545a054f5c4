import { Unzlib, unzlibSync } from 'three/addons/libs/fflate.module.js';
import { FbxLimits, type FbxNode, type FbxNumbers, type FbxValue } from './fbx-node';

const headerLength = 27;
const text = new TextDecoder();

const maxPackedArrays = 100_000;
/** The packed bytes that are unpacked at once: if more comes out than is stated, that takes 0.2 s. */
const packedAtOnce = 2 ** 16;
/** The most bytes that one packed byte of DEFLATE can hold (zlib.net, "Maximum Compression Factor"). */
const maxExpansion = 1032;

/** Unpacks an array of an FBX file. Throws if its length is not the stated one. */
function unpack(packed: Uint8Array, length: number): Uint8Array {
  if (length > maxExpansion * packed.length) throw new Error('has an array that is shorter than it says');
  // A stream has tables of 130 kB: small arrays are unpacked without one, in a tenth of the time.
  const isSmall = packed.length <= packedAtOnce;
  const unpacked = isSmall ? unzlibSync(packed, { out: new Uint8Array(length + 1) }) : unpackStream(packed, length);
  if (unpacked.length > length) throw new Error('has an array that is longer than it says');
  if (unpacked.length < length) throw new Error('has an array that is shorter than it says');
  return unpacked;
}

/** Unpacks an array until it has more bytes than are stated. */
function unpackStream(packed: Uint8Array, length: number): Uint8Array {
  const unpacked = new Uint8Array(length + 1);
  let count = 0;
  const stream = new Unzlib((chunk) => {
    unpacked.set(chunk.subarray(0, unpacked.length - count), count);
    count = Math.min(count + chunk.length, unpacked.length);
  });
  for (let at = 0; at < packed.length && count <= length; at += packedAtOnce) {
    stream.push(packed.subarray(at, at + packedAtOnce), at + packedAtOnce >= packed.length);
  }
  return unpacked.subarray(0, count);
}

/** The kinds of lists by their letter: the size of a number [bytes], and how the numbers are read. */
const lists: Readonly<Record<string, { readonly size: number; read(bytes: ArrayBuffer, count: number): FbxNumbers }>> =
  {
    b: { size: 1, read: (bytes, count) => Int32Array.from(new Uint8Array(bytes, 0, count)) },
    c: { size: 1, read: (bytes, count) => Int32Array.from(new Uint8Array(bytes, 0, count)) },
    i: { size: 4, read: (bytes, count) => new Int32Array(bytes, 0, count) },
    f: { size: 4, read: (bytes, count) => new Float32Array(bytes, 0, count) },
    l: { size: 8, read: (bytes, count) => Float64Array.from(new BigInt64Array(bytes, 0, count), Number) },
    d: { size: 8, read: (bytes, count) => new Float64Array(bytes, 0, count) },
  };
const numbers: Readonly<Record<string, { readonly size: number; read(view: DataView, at: number): number }>> = {
  C: { size: 1, read: (view, at) => view.getUint8(at) & 1 },
  Y: { size: 2, read: (view, at) => view.getInt16(at, true) },
  I: { size: 4, read: (view, at) => view.getInt32(at, true) },
  F: { size: 4, read: (view, at) => view.getFloat32(at, true) },
  L: { size: 8, read: (view, at) => Number(view.getBigInt64(at, true)) },
  D: { size: 8, read: (view, at) => view.getFloat64(at, true) },
};

class BinaryFbx {
  readonly #bytes: Uint8Array;
  readonly #view: DataView;
  readonly #wide: boolean;
  readonly #limits = new FbxLimits();
  /** Reads the lists, which are read once all have been counted. */
  readonly #lists: (() => void)[] = [];
  #packedArrays = 0;
  #at = headerLength;

  constructor(
    bytes: Uint8Array,
    readonly isNeeded: (name: string) => boolean,
  ) {
    this.#bytes = bytes;
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.#wide = this.#view.getUint32(23, true) >= 7500;
  }

  read(): readonly FbxNode[] {
    const nodes = this.#nodes(this.#bytes.length, 0);
    if (nodes.length === 0) throw new Error('holds nothing');
    for (const read of this.#lists) read();
    return nodes;
  }

  /** Reads the nodes up to `end`, or to the record that ends a list. */
  #nodes(end: number, depth: number): FbxNode[] {
    const nodes: FbxNode[] = [];
    while (this.#at < end) {
      const nodeEnd = this.#offset(end);
      const [properties, _length] = [this.#offset(end), this.#offset(end)];
      const name = this.#text(this.#view.getUint8(this.#take(1, end)), end);
      if (nodeEnd === 0) break;
      if (nodeEnd < this.#at || nodeEnd > end) throw new Error('is cut short or damaged');
      if (this.isNeeded(name)) {
        this.#limits.countNode(depth);
        const values: FbxValue[] = [];
        for (let i = 0; i < properties; i++) this.#property(values, nodeEnd);
        nodes.push({ name, values, children: this.#nodes(nodeEnd, depth + 1) });
      }
      this.#at = nodeEnd;
    }
    return nodes;
  }

  #take(length: number, end: number): number {
    const at = this.#at;
    if (!(at + length <= end)) throw new Error('is cut short or damaged');
    this.#at = at + length;
    return at;
  }

  #offset(end: number): number {
    if (!this.#wide) return this.#view.getUint32(this.#take(4, end), true);
    return Number(this.#view.getBigUint64(this.#take(8, end), true));
  }

  /** Returns a text up to its first null; names are followed by a null and their class. */
  #text(length: number, end: number): string {
    const at = this.#take(length, end);
    const bytes = this.#bytes.subarray(at, at + length);
    const terminator = bytes.indexOf(0);
    return text.decode(terminator < 0 ? bytes : bytes.subarray(0, terminator));
  }

  #property(values: FbxValue[], end: number): void {
    const type = String.fromCharCode(this.#view.getUint8(this.#take(1, end)));
    const number = numbers[type];
    if (number) values.push(number.read(this.#view, this.#take(number.size, end)));
    else if (type === 'S') values.push(this.#text(this.#view.getUint32(this.#take(4, end), true), end));
    else if (type === 'R') {
      const length = this.#view.getUint32(this.#take(4, end), true);
      const at = this.#take(length, end);
      values.push(this.#bytes.subarray(at, at + length));
    } else if (lists[type]) this.#list(values, lists[type], end);
    else throw new Error('is damaged: it has a property of an unknown kind');
  }

  #list(values: FbxValue[], { size, read }: (typeof lists)[string], end: number): void {
    const at = this.#take(12, end);
    const count = this.#view.getUint32(at, true);
    const isPacked = this.#view.getUint32(at + 4, true) !== 0;
    this.#limits.countNumbers(count);
    const begin = this.#take(isPacked ? this.#view.getUint32(at + 8, true) : count * size, end);
    const raw = this.#bytes.subarray(begin, this.#at);
    if (isPacked) this.#packedArrays += 1;
    if (this.#packedArrays > maxPackedArrays) throw new Error(`holds more than ${maxPackedArrays} packed arrays`);
    const index = values.push(0) - 1;
    this.#lists.push(() => {
      values[index] = read((isPacked ? unpack(raw, count * size) : raw.slice()).buffer as ArrayBuffer, count);
    });
  }
}

/** Reads the needed nodes of a binary file. Throws the end of a sentence about the file. */
export function readBinaryFbx(bytes: Uint8Array, isNeeded: (name: string) => boolean): readonly FbxNode[] {
  const version = bytes.length < headerLength ? 0 : new DataView(bytes.buffer, bytes.byteOffset).getUint32(23, true);
  if (version < 6400)
    throw new Error(`is FBX of version ${version / 1000}, and 7 is read; save it as FBX 2013 or later`);
  return new BinaryFbx(bytes, isNeeded).read();
}
