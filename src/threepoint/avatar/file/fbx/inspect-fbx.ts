import { Unzlib } from 'three/addons/libs/fflate.module.js';
import { isBinaryFbx } from './is-fbx';

const headerLength = 27;
const latin = new TextDecoder('latin1');

/** The limit of an FBX file's numbers; the converted body is checked again. */
const maxNumbers = 40e6;
/** Unpacking an array takes 65 µs (measured): its tables have 130 kB, here and in the loader. */
const maxPackedArrays = 100_000;
const deepestNesting = 32;
/** The largest polygon that is cut into triangles [corners]. */
const maxCorners = 1000;
/** The limit of subdivisions of all curves: the loader subdivides turns of more than half a circle. */
const maxSubdivisions = 2e6;
/** The number of packed bytes that are unpacked at once: at most `maxExpansion` times as many come out. */
const packedAtOnce = 2 ** 12;
/** The most bytes that one packed byte of DEFLATE can hold (zlib.net, "Maximum Compression Factor"). */
const maxExpansion = 1032;

/** The objects for which FBXLoader needs a window; a body needs none of them. */
const unneeded = /^(Camera|Light|NurbsCurve)$/;
const none = 'Null';

/** The lists of values and of indices in each layer of a mesh; some programs write layers without one. */
const listsOfLayer: Readonly<Record<string, { readonly values: string; readonly indices: string }>> = {
  LayerElementNormal: { values: 'Normals', indices: 'NormalsIndex' },
  LayerElementUV: { values: 'UV', indices: 'UVIndex' },
  LayerElementColor: { values: 'Colors', indices: 'ColorIndex' },
  LayerElementMaterial: { values: 'Materials', indices: 'Materials' },
};
const byIndex = 'IndexToDirect';
const direct = 'Direct';

/** Throws for a name of Object.prototype, which the loader would overwrite. */
const demandPlainName = (name: string): void => {
  if (name in {}) throw new Error(`a node is called “${name}”`);
};

/** Checks the numbers on which the work of the loader depends. */
class ArrayChecks {
  #numbers = 0;
  #subdivisions = 0;

  count(numbers: number): void {
    this.#numbers += numbers;
    if (this.#numbers > maxNumbers) throw new Error(`holds more than ${maxNumbers / 1e6} million numbers`);
  }

  /** Returns whether the values of a node must be checked. */
  needs(name: string): boolean {
    return name === 'PolygonVertexIndex' || name === 'KeyValueFloat';
  }

  check(name: string, values: Iterable<number>): void {
    if (name === 'PolygonVertexIndex') this.#checkPolygons(values);
    else this.#checkCurve(values);
  }

  /** Limits the corners of each polygon; the last corner of a polygon is negative. */
  #checkPolygons(corners: Iterable<number>): void {
    let count = 0;
    for (const corner of corners) {
      count += 1;
      if (count > maxCorners) throw new Error(`has a polygon of more than ${maxCorners} corners`);
      if (corner < 0) count = 0;
    }
  }

  #checkCurve(values: Iterable<number>): void {
    let before: number | null = null;
    for (const value of values) {
      if (!Number.isFinite(value)) throw new Error('has an animation whose values are not finite');
      this.#subdivisions += before === null ? 0 : Math.abs(value - before) / 180;
      before = value;
    }
    if (this.#subdivisions > maxSubdivisions) throw new Error('has an animation that turns without end');
  }
}

/** Unpacks an array of an FBX file; returns null without `keep`. Throws if its length is not the stated one. */
function unpack(packed: Uint8Array, length: number, keep: boolean): Uint8Array | null {
  if (length > maxExpansion * packed.length) throw new Error('has an array that is shorter than it says');
  const kept = keep ? new Uint8Array(length) : null;
  let count = 0;
  const stream = new Unzlib((chunk) => {
    if (count + chunk.length > length) throw new Error('has an array that is longer than it says');
    kept?.set(chunk, count);
    count += chunk.length;
  });
  for (let at = 0; at < packed.length; at += packedAtOnce) {
    stream.push(packed.subarray(at, at + packedAtOnce), at + packedAtOnce >= packed.length);
  }
  if (count !== length) throw new Error('has an array that is shorter than it says');
  return kept;
}

/** An array of a file that must be unpacked or checked. */
interface StoredArray {
  readonly name: string;
  readonly type: string;
  readonly raw: Uint8Array;
  readonly isPacked: boolean;
  /** Unpacked [bytes]. */
  readonly length: number;
}

const arrayTypes: Readonly<Record<string, number>> = { b: 1, c: 1, i: 4, f: 4, l: 8, d: 8 };
const plainTypes: Readonly<Record<string, number>> = { C: 1, Y: 2, I: 4, F: 4, L: 8, D: 8 };

/** Walks through the nodes of a binary file and overwrites the parts that FBXLoader cannot read. */
class BinaryWalk {
  readonly #bytes: Uint8Array;
  readonly #view: DataView;
  readonly #wide: boolean;
  readonly #checks = new ArrayChecks();
  readonly #arrays: StoredArray[] = [];
  #at = headerLength;
  /** The bytes of the text in the newest layer by which its values have a list of indices; null: none. */
  #reference: Uint8Array | null = null;

  constructor(bytes: Uint8Array) {
    this.#bytes = bytes;
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.#wide = this.#view.getUint32(23, true) >= 7500;
  }

  /** Returns the end of the last node. */
  walk(): number {
    let end = this.#at;
    while (this.#at < this.#bytes.length && this.#node(this.#bytes.length, 0) !== null) end = this.#at;
    if (end === headerLength) throw new Error('holds nothing');
    const packed = this.#arrays.filter(({ isPacked }) => isPacked).length;
    if (packed > maxPackedArrays) throw new Error(`holds more than ${maxPackedArrays} packed arrays`);
    for (const array of this.#arrays) this.#checkArray(array);
    return end;
  }

  #take(length: number, end: number): number {
    const at = this.#at;
    if (!(at + length <= end)) throw new Error('is cut short or damaged');
    this.#at = at + length;
    return at;
  }

  #offset(end: number): number {
    if (!this.#wide) return this.#view.getUint32(this.#take(4, end), true);
    const at = this.#take(8, end);
    return this.#view.getUint32(at, true) + this.#view.getUint32(at + 4, true) * 2 ** 32;
  }

  /** Returns the name of a node; null at the record that ends a list. */
  #node(outerEnd: number, depth: number): string | null {
    const [end, properties, _length] = [this.#offset(outerEnd), this.#offset(outerEnd), this.#offset(outerEnd)];
    const nameLength = this.#view.getUint8(this.#take(1, outerEnd));
    const nameAt = this.#take(nameLength, outerEnd);
    if (end === 0) return null;
    if (end < this.#at || end > outerEnd) throw new Error('is cut short or damaged');
    if (depth > deepestNesting) throw new Error(`is nested deeper than ${deepestNesting} levels`);
    const name = latin.decode(this.#bytes.subarray(nameAt, nameAt + nameLength));
    demandPlainName(name);
    for (let i = 0; i < properties; i++) this.#property(name, end);
    const lists = listsOfLayer[name];
    if (lists) this.#reference = null;
    const below = new Set<string | null>();
    while (this.#at < end) below.add(this.#node(end, depth + 1));
    // FBXLoader ignores layers with other names.
    if (lists && !below.has(lists.values)) this.#bytes.fill(0x5f, nameAt, nameAt + nameLength);
    else if (lists && !below.has(lists.indices)) this.#overwrite(this.#reference, direct);
    return name;
  }

  #property(name: string, end: number): void {
    const type = String.fromCharCode(this.#view.getUint8(this.#take(1, end)));
    const size = plainTypes[type];
    if (size !== undefined) this.#take(size, end);
    else if (type === 'R' || type === 'S') {
      const length = this.#view.getUint32(this.#take(4, end), true);
      const at = this.#take(length, end);
      if (type === 'S') this.#readText(this.#bytes.subarray(at, at + length));
    } else if (arrayTypes[type]) this.#array(name, type, end);
    else throw new Error('is damaged: it has a property of an unknown kind');
  }

  #readText(text: Uint8Array): void {
    if (text.length > byIndex.length) return;
    const read = latin.decode(text);
    if (read === byIndex) this.#reference = text;
    if (unneeded.test(read)) this.#overwrite(text, none);
  }

  #overwrite(text: Uint8Array | null, by: string): void {
    text?.fill(0);
    text?.set(new TextEncoder().encode(by));
    this.#reference = null;
  }

  #array(name: string, type: string, end: number): void {
    const at = this.#take(12, end);
    const [count, encoding, packedLength] = [0, 4, 8].map((each) => this.#view.getUint32(at + each, true)) as [
      number,
      number,
      number,
    ];
    this.#checks.count(count);
    const length = count * arrayTypes[type]!;
    const isPacked = encoding !== 0;
    const begin = this.#take(isPacked ? packedLength : length, end);
    this.#arrays.push({ name, type, raw: this.#bytes.subarray(begin, this.#at), isPacked, length });
  }

  #checkArray({ name, type, raw, isPacked, length }: StoredArray): void {
    const needed = this.#checks.needs(name) && (type === 'i' || type === 'f' || type === 'd');
    const values = isPacked ? unpack(raw, length, needed) : needed ? raw.slice() : null;
    if (!values) return;
    const kind = type === 'i' ? Int32Array : type === 'f' ? Float32Array : Float64Array;
    this.#checks.check(name, new kind(values.buffer as ArrayBuffer));
  }
}

/** Returns a binary file without the parts that FBXLoader cannot read and without the bytes after its last node. */
function plainBinary(bytes: Uint8Array): ArrayBuffer {
  const version = bytes.length < headerLength ? 0 : new DataView(bytes.buffer, bytes.byteOffset).getUint32(23, true);
  if (version < 6400)
    throw new Error(`is FBX of version ${version / 1000}, and 7 is read; save it as FBX 2013 or later`);
  const copy = bytes.slice();
  const end = new BinaryWalk(copy).walk();
  // The reader stops 176 bytes before the end of a file, and expects files in steps of 16 bytes to be padded.
  const length = (end + 164) % 16 === 0 ? end + 165 : end + 164;
  const plain = new Uint8Array(length);
  plain.set(copy.subarray(0, end));
  return plain.buffer;
}

const numberLists = /\b(PolygonVertexIndex|KeyValueFloat):\s*\*\d+\s*\{\s*a:\s*([^}]*)\}/g;

/** Returns FBX as text without the parts that FBXLoader cannot read. */
function plainText(bytes: Uint8Array): ArrayBuffer {
  const text = new TextDecoder().decode(bytes);
  const version = Number(/FBXVersion: (\d+)/.exec(text)?.[1] ?? 0);
  if (!/^\s*;/.test(text) && version === 0) throw new Error('is no FBX file');
  if (version < 7000)
    throw new Error(`is FBX of version ${version / 1000}, and 7 is read; save it as FBX 2013 or later`);
  const checks = new ArrayChecks();
  for (const [, name] of text.matchAll(/^\s*(\w+):/gm)) demandPlainName(name!);
  for (const [, name, list] of text.matchAll(numberLists)) checks.check(name!, list!.split(',').map(Number));
  const plain = text.replace(/,\s*"(Camera|Light|NurbsCurve)"\s*\{/g, `, "${none}" {`);
  return new TextEncoder().encode(plain).buffer;
}

/**
 * Returns an FBX file that three.js's loader can read without a window, in bounded time. Throws the end of a sentence
 * about the file if its parts do not fit together or a limit is exceeded.
 */
export const plainFbx = (bytes: Uint8Array): ArrayBuffer =>
  isBinaryFbx(bytes) ? plainBinary(bytes) : plainText(bytes);
