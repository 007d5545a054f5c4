import { type FbxNode, type FbxValue, isNumbers } from './fbx-node';

const magic = 'Kaydara FBX Binary  \0\u001a\0';
const version = 7400;
/** The lengths of a node without its name and content, and of the record that ends a list of nodes [bytes]. */
const recordLength = 13;
/** The length of the end of a file, which FBXLoader skips [bytes]. */
const footerLength = 176;

const encoder = new TextEncoder();
const sum = <T>(items: readonly T[], lengthOf: (item: T) => number): number =>
  items.reduce((length, item) => length + lengthOf(item), 0);

function valueLength(value: FbxValue): number {
  if (typeof value === 'number') return 9;
  if (typeof value === 'string') return 5 + encoder.encode(value).length;
  return isNumbers(value) ? 13 + value.byteLength : 5 + value.length;
}

const childrenLength = (children: readonly FbxNode[]): number =>
  children.length === 0 ? 0 : sum(children, nodeLength) + recordLength;

const nodeLength = ({ name, values, children }: FbxNode): number =>
  recordLength + name.length + sum(values, valueLength) + childrenLength(children);

/** Writes binary FBX without compression. */
export function writeFbx(nodes: readonly FbxNode[]): ArrayBuffer {
  const bytes = new Uint8Array(magic.length + 4 + sum(nodes, nodeLength) + footerLength);
  const view = new DataView(bytes.buffer);
  let at = 0;
  const write = (part: Uint8Array): void => {
    bytes.set(part, at);
    at += part.length;
  };
  const writeText = (text: string): void => write(encoder.encode(text));
  const writeWord = (value: number): void => {
    view.setUint32(at, value, true);
    at += 4;
  };
  const writeValue = (value: FbxValue): void => {
    if (typeof value === 'number') {
      writeText('D');
      view.setFloat64(at, value, true);
      at += 8;
    } else if (isNumbers(value)) {
      writeText(value instanceof Float64Array ? 'd' : value instanceof Float32Array ? 'f' : 'i');
      for (const word of [value.length, 0, value.byteLength]) writeWord(word);
      write(new Uint8Array(value.buffer, value.byteOffset, value.byteLength));
    } else {
      writeText(typeof value === 'string' ? 'S' : 'R');
      const content = typeof value === 'string' ? encoder.encode(value) : value;
      writeWord(content.length);
      write(content);
    }
  };
  const writeNode = (node: FbxNode): void => {
    const { name, values, children } = node;
    // The third word is the length of the values, which FBXLoader does not read.
    for (const word of [at + nodeLength(node), values.length, 0]) writeWord(word);
    bytes[at++] = name.length;
    writeText(name);
    for (const value of values) writeValue(value);
    for (const child of children) writeNode(child);
    if (children.length > 0) at += recordLength;
  };
  writeText(magic);
  writeWord(version);
  for (const node of nodes) writeNode(node);
  return bytes.buffer;
}
