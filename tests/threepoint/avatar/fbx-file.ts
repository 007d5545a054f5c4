import { deflateSync } from 'node:zlib';

/** An integer that FBX keeps in 64 bits: numbers of objects and times. */
export interface Long {
  readonly long: number;
}
type Property = string | number | Long | readonly number[] | Int32Array | Float32Array | BigInt64Array | Uint8Array;

/** A node of an FBX file. */
export interface FbxNode {
  readonly name: string;
  readonly properties: readonly Property[];
  readonly children: readonly FbxNode[];
}

export const long = (value: number): Long => ({ long: value });
export const fbxNode = (name: string, properties: readonly Property[] = [], children: readonly FbxNode[] = []) => ({
  ...{ name, properties, children },
});

const isList = (property: Property): property is Exclude<Property, string | number | Long> =>
  typeof property === 'object' && !('long' in property);

/** Writes FBX 7.4 as text. */
export function fbxText(nodes: readonly FbxNode[]): ArrayBuffer {
  const lines = ['; FBX 7.4.0 project file'];
  const value = (property: Property): string =>
    typeof property === 'string'
      ? `"${property}"`
      : typeof property === 'number'
        ? `${property}`
        : `${(property as Long).long}`;
  const write = ({ name, properties, children }: FbxNode, depth: number): void => {
    const indent = '\t'.repeat(depth);
    const [first] = properties;
    if (first !== undefined && isList(first)) {
      lines.push(`${indent}${name}: *${first.length} {`, `${indent}\ta: ${[...first].join(',')}`, `${indent}} `);
    } else if (children.length === 0 && properties.length > 0) {
      // Readers of text expect no blanks before the numbers of a property.
      lines.push(`${indent}${name}: ${properties.map(value).join(name === 'P' ? ',' : ', ')}`);
    } else {
      lines.push(`${indent}${name}: ${properties.map(value).join(', ')} {`);
      for (const child of children) write(child, depth + 1);
      lines.push(`${indent}}`);
    }
  };
  for (const node of nodes) write(node, 0);
  return new TextEncoder().encode(`${lines.join('\n')}\n`).buffer;
}

const u32 = (value: number): Buffer => {
  const bytes = Buffer.alloc(4);
  bytes.writeUInt32LE(value);
  return bytes;
};

function propertyBytes(property: Property, pack: ((bytes: Uint8Array) => Uint8Array) | undefined): Buffer {
  if (typeof property === 'string') {
    // In binary files the class stands behind the name.
    const text = Buffer.from(property.replace(/^(\w*)::(.*)$/, '$2\0\u0001$1'), 'latin1');
    return Buffer.concat([Buffer.from('S'), u32(text.length), text]);
  }
  if (typeof property === 'number') {
    const bytes = Buffer.alloc(9);
    const isWhole = (property | 0) === property;
    bytes.write(isWhole ? 'I' : 'D', 0, 'latin1');
    if (isWhole) bytes.writeInt32LE(property, 1);
    else bytes.writeDoubleLE(property, 1);
    return isWhole ? bytes.subarray(0, 5) : bytes;
  }
  if (!isList(property)) {
    const bytes = Buffer.alloc(9, 'L');
    bytes.writeBigInt64LE(BigInt(property.long), 1);
    return bytes;
  }
  if (property instanceof Uint8Array) return Buffer.concat([Buffer.from('R'), u32(property.length), property]);
  const [type, list] =
    property instanceof Int32Array
      ? ['i', property]
      : property instanceof Float32Array
        ? ['f', property]
        : property instanceof BigInt64Array
          ? ['l', property]
          : ['d', Float64Array.from(property)];
  const raw = new Uint8Array(list.buffer);
  const stored = pack ? pack(raw) : raw;
  return Buffer.concat([Buffer.from(type), u32(list.length), u32(pack ? 1 : 0), u32(stored.length), stored]);
}

/** Writes binary FBX 7.4. `pack`: how arrays are compressed; absent: they are not. */
export function fbxBinary(nodes: readonly FbxNode[], pack?: (bytes: Uint8Array) => Uint8Array): ArrayBuffer {
  const header = Buffer.concat([Buffer.from('Kaydara FBX Binary  \0\u001a\0', 'latin1'), u32(7400)]);
  const record = ({ name, properties, children }: FbxNode, at: number): Buffer => {
    const list = Buffer.concat(properties.map((property) => propertyBytes(property, pack)));
    const begin = at + 13 + name.length + list.length;
    const below = records(children, begin, children.length > 0);
    const sizes = [u32(begin + below.length), u32(properties.length), u32(list.length)];
    return Buffer.concat([...sizes, Buffer.from([name.length]), Buffer.from(name, 'latin1'), list, below]);
  };
  const records = (list: readonly FbxNode[], at: number, ended: boolean): Buffer => {
    const written: Buffer[] = [];
    let length = 0;
    for (const node of list) {
      const bytes = record(node, at + length);
      written.push(bytes);
      length += bytes.length;
    }
    return Buffer.concat([...written, Buffer.alloc(ended ? 13 : 0)]);
  };
  const whole = Buffer.concat([header, records(nodes, header.length, true), Buffer.alloc(176)]);
  return whole.buffer.slice(whole.byteOffset, whole.byteOffset + whole.length) as ArrayBuffer;
}

/** Writes binary FBX 7.4 with packed arrays. */
export const fbxPacked = (nodes: readonly FbxNode[]): ArrayBuffer => fbxBinary(nodes, deflateSync);

/** The forms of a file, and what writes them. */
export const fbxForms = [
  ['text', fbxText],
  ['binary', (nodes: readonly FbxNode[]) => fbxBinary(nodes)],
  ['packed binary', fbxPacked],
] as const;
