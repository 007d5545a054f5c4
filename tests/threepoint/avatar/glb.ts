import { readFileSync } from 'node:fs';

const bytes = readFileSync(new URL('../../../public/avatars/mannequin.vrm', import.meta.url));

/** The JSON of a GLB file, as far as tests change it. */
export interface GltfJson {
  [field: string]: unknown;
  nodes: {
    name: string;
    translation?: number[];
    rotation?: number[];
    children?: number[];
    mesh?: number;
    skin?: number;
  }[];
  meshes: {
    extras?: { targetNames?: string[] };
    weights?: number[];
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

const copy = (file: Uint8Array): ArrayBuffer =>
  file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength) as ArrayBuffer;

/** A length that is filled up to whole words, as GLB wants its parts. */
export const padded = (length: number): number => Math.ceil(length / 4) * 4;

/** What a GLB file consists of. */
export function partsOf(file: Uint8Array | ArrayBuffer): { readonly json: GltfJson; readonly binary: Buffer } {
  const whole =
    file instanceof ArrayBuffer ? Buffer.from(file) : Buffer.from(file.buffer, file.byteOffset, file.length);
  const length = whole.readUInt32LE(12);
  return {
    json: JSON.parse(whole.toString('utf8', 20, 20 + length)) as GltfJson,
    binary: whole.subarray(28 + length),
  };
}

/** The GLB file of this JSON and binary part. */
export function glbOf(json: unknown, binary: Uint8Array): ArrayBuffer {
  const text = Buffer.from(JSON.stringify(json));
  const begin = 20 + padded(text.length);
  const file = Buffer.alloc(begin + 8 + padded(binary.length));
  file.write('glTF', 0, 'latin1');
  file.writeUInt32LE(2, 4);
  file.writeUInt32LE(file.length, 8);
  file.writeUInt32LE(padded(text.length), 12);
  file.write('JSON', 16, 'latin1');
  file.fill(' ', 20, begin);
  file.set(text, 20);
  file.writeUInt32LE(padded(binary.length), begin);
  file.write('BIN\0', begin + 4, 'latin1');
  file.set(binary, begin + 8);
  return copy(file);
}

/** Our own avatar's file. */
export const mannequin = (): ArrayBuffer => copy(bytes);

/** The mannequin's file, or this one, with its JSON changed, and more put at the end of its binary part. */
export function changed(
  change: (json: GltfJson, binaryLength: number) => void,
  file: Uint8Array | ArrayBuffer = bytes,
  more: Uint8Array = new Uint8Array(),
): ArrayBuffer {
  const { json, binary } = partsOf(file);
  change(json, binary.length);
  return glbOf(json, Buffer.concat([binary, more]));
}

/** The first bytes of a PNG of this size. */
export function pngHeader(width: number, height: number): Buffer {
  const png = Buffer.alloc(64);
  png.write('\x89PNG\r\n\x1a\n', 0, 'latin1');
  png.writeUInt32BE(13, 8);
  png.write('IHDR', 12, 'latin1');
  png.writeUInt32BE(width, 16);
  png.writeUInt32BE(height, 20);
  return png;
}

/** A file with so many pictures that nothing shows, all of them these bytes. */
export const withPictures = (count: number, picture: Uint8Array, file?: ArrayBuffer): ArrayBuffer =>
  changed(
    (json, binaryLength) => {
      json.bufferViews.push({ buffer: 0, byteOffset: binaryLength, byteLength: picture.length });
      const image = { bufferView: json.bufferViews.length - 1, mimeType: 'image/png' };
      json.images = Array.from({ length: count }, () => image);
    },
    file,
    picture,
  );

/** VRM 0.x: faces −Z at rest, bones in a list. */
export const old = changed((json) => {
  const bones = json.extensions.VRMC_vrm?.humanoid.humanBones ?? {};
  delete json.extensions.VRMC_vrm;
  json.extensionsUsed = ['VRM'];
  json.extensions.VRM = {
    specVersion: '0.0',
    meta: { title: 'old', licenseName: 'CC0' },
    humanoid: {
      humanBones: Object.entries(bones)
        .filter(([name]) => !name.includes('Thumb'))
        .map(([bone, { node }]) => ({ bone, node })),
    },
    firstPerson: { meshAnnotations: [] },
    blendShapeMaster: { blendShapeGroups: [] },
    secondaryAnimation: { boneGroups: [], colliderGroups: [] },
    materialProperties: [],
  };
  for (const node of json.nodes) {
    if (node.translation)
      node.translation = [-(node.translation[0] ?? 0), node.translation[1] ?? 0, -(node.translation[2] ?? 0)];
  }
});
