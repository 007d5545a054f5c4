import { readFileSync } from 'node:fs';

const bytes = readFileSync(new URL('../../public/avatars/mannequin.vrm', import.meta.url));

/** The JSON of a GLB file, as far as tests change it. */
export interface GltfJson {
  [field: string]: unknown;
  nodes: { name: string; translation?: number[]; rotation?: number[]; children?: number[]; mesh?: number }[];
  meshes: {
    primitives: { attributes: Record<string, number>; indices?: number; targets?: Record<string, number>[] }[];
  }[];
  accessors: { count: number; type: string; bufferView?: number; componentType: number; max?: number[] }[];
  bufferViews: { buffer: number; byteOffset?: number; byteLength: number }[];
  buffers: { byteLength: number; uri?: string }[];
  images?: { uri?: string; bufferView?: number; mimeType?: string }[];
  skins: { joints: number[] }[];
  extensionsUsed: string[];
  extensions: Record<string, unknown> & {
    VRMC_vrm?: { humanoid: { humanBones: Record<string, { node: number }> } };
    VRM?: unknown;
  };
}

const copy = (file: Buffer): ArrayBuffer =>
  file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength) as ArrayBuffer;

/** Our own avatar's file. */
export const mannequin = (): ArrayBuffer => copy(bytes);

/** The mannequin's file with its JSON changed, and more put at the end of its binary part. */
export function changed(
  change: (json: GltfJson, binaryLength: number) => void,
  more: Uint8Array = new Uint8Array(),
): ArrayBuffer {
  const length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.toString('utf8', 20, 20 + length)) as GltfJson;
  const binary = bytes.subarray(20 + length + 8);
  change(json, binary.length);
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const whole = Buffer.concat([binary, more, Buffer.alloc((4 - (more.length % 4)) % 4)]);
  const header = Buffer.from(bytes.subarray(0, 20));
  header.writeUInt32LE(20 + padded.length + 8 + whole.length, 8);
  header.writeUInt32LE(padded.length, 12);
  const chunk = Buffer.alloc(8);
  chunk.writeUInt32LE(whole.length, 0);
  chunk.write('BIN\0', 4, 'latin1');
  return copy(Buffer.concat([header, padded, chunk, whole]));
}
