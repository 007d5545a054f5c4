import { crc32, deflateSync } from 'node:zlib';
import { changed, type GltfJson } from './glb';

/** One chunk of a PNG file. */
function pngChunk(type: string, data: Buffer): Buffer {
  const chunk = Buffer.alloc(12 + data.length);
  chunk.writeUInt32BE(data.length, 0);
  chunk.write(type, 4, 'latin1');
  data.copy(chunk, 8);
  chunk.writeUInt32BE(crc32(chunk.subarray(4, 8 + data.length)), 8 + data.length);
  return chunk;
}

/**
 * A painted square of so many pixels a side: soft shades with a grain, about a byte for each pixel, as skins and
 * clothes have it.
 */
function paintedPng(side: number, shade: number): Buffer {
  const rows = Buffer.alloc(side * (1 + 3 * side));
  let grain = 1 + shade;
  for (let y = 0; y < side; y++) {
    const row = y * (1 + 3 * side) + 1;
    for (let x = 0; x < side; x++) {
      grain = (Math.imul(grain, 1_103_515_245) + 12_345) & 0x7fffffff;
      for (let c = 0; c < 3; c++) {
        rows[row + 3 * x + c] =
          90 + 20 * c + ((x + y * (shade + 1)) >> 5) * 2 + ((grain >> (16 + 3 * c)) & (c === 1 ? 3 : 0));
      }
    }
  }
  const head = Buffer.alloc(13);
  head.writeUInt32BE(side, 0);
  head.writeUInt32BE(side, 4);
  head.set([8, 2, 0, 0, 0], 8);
  return Buffer.concat([
    Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'),
    pngChunk('IHDR', head),
    pngChunk('IDAT', deflateSync(rows, { level: 1 })),
    pngChunk('IEND', Buffer.alloc(0)),
  ]);
}

export interface LargeAvatarOptions {
  /** Pictures, each 2048 pixels a side: some 4 MB. */
  readonly pictures: number;
  /** Suits over each other: 12,000 triangles each. */
  readonly layers: number;
  /** Shapes of the face. */
  readonly shapes: number;
  /** Painted as VRoid's bodies are: MToon with outlines. */
  readonly mtoon: boolean;
}

/**
 * A VRM as large as people's own avatars are: the mannequin with layers of cloth, shapes of the face and painted
 * pictures.
 */
export function largeAvatar({ pictures, layers, shapes, mtoon }: LargeAvatarOptions): ArrayBuffer {
  const painted = Array.from({ length: pictures }, (_, i) => paintedPng(2048, i));
  const padding = (length: number) => Buffer.alloc((4 - (length % 4)) % 4);
  return changed(
    (json, length) => {
      let at = Math.ceil(length / 4) * 4;
      addPictures(json, painted, at);
      at += painted.reduce((sum, { length }) => sum + length + padding(length).length, 0);
      json.buffers = [{ byteLength: at }];
      addLayers(json, layers);
      addShapes(json, shapes);
      if (mtoon) paintAsToon(json);
    },
    undefined,
    Buffer.concat([padding(0), ...painted.flatMap((png) => [png, padding(png.length)])]),
  );
}

type Painted = GltfJson & {
  materials: { name: string; extensions?: object; pbrMetallicRoughness: object }[];
  textures: { source: number }[];
  images: { bufferView: number; mimeType: string }[];
};

function addPictures(gltf: GltfJson, painted: readonly Buffer[], from: number): void {
  const json = gltf as Painted;
  let at = from;
  json.images = [];
  json.textures = [];
  for (const [i, png] of painted.entries()) {
    json.bufferViews.push({ buffer: 0, byteOffset: at, byteLength: png.length });
    json.images.push({ bufferView: json.bufferViews.length - 1, mimeType: 'image/png' });
    json.textures.push({ source: i });
    at += Math.ceil(png.length / 4) * 4;
    const [first] = json.materials;
    if (first)
      json.materials.push({ ...first, name: `Cloth ${i}`, pbrMetallicRoughness: { baseColorTexture: { index: i } } });
  }
}

function addLayers(gltf: GltfJson, layers: number): void {
  const json = gltf as Painted;
  const body = json.meshes[0]?.primitives ?? [];
  const cloths = json.materials.flatMap(({ name }, index) => (name.startsWith('Cloth') ? [index] : []));
  for (let i = 0; i < layers; i++) {
    const material = cloths[i % cloths.length];
    const clothed = { ...(material !== undefined && { material }) };
    json.meshes.push({ primitives: body.map((primitive) => ({ ...withPlaces(json, primitive), ...clothed })) });
    json.nodes.push({ name: `layer ${i}`, mesh: json.meshes.length - 1, skin: 0 } as GltfJson['nodes'][number]);
    (json as unknown as { scenes: { nodes: number[] }[] }).scenes[0]?.nodes.push(json.nodes.length - 1);
  }
}

/** A primitive on which a picture has its place: x and y of each corner. */
function withPlaces(json: GltfJson, primitive: GltfJson['meshes'][number]['primitives'][number]) {
  const {
    min: _,
    max: __,
    ...position
  } = json.accessors[primitive.attributes.POSITION ?? -1] as GltfJson['accessors'][number] & {
    min?: unknown;
  };
  json.accessors.push({ ...position, type: 'VEC2' });
  return { ...primitive, attributes: { ...primitive.attributes, TEXCOORD_0: json.accessors.length - 1 } };
}

function addShapes(json: GltfJson, shapes: number): void {
  const [, face] = json.meshes;
  if (!face) return;
  face.weights = Array.from({ length: shapes }, () => 0);
  face.extras = { targetNames: face.weights.map((_, shape) => `shape ${shape}`) };
  for (const primitive of face.primitives) {
    const normal = json.accessors[primitive.attributes.NORMAL ?? -1];
    if (!normal) continue;
    // Moved along its normals by up to a metre: what a shape looks like does not matter here.
    json.accessors.push({ ...normal, min: [-1, -1, -1], max: [1, 1, 1] } as typeof normal);
    const POSITION = json.accessors.length - 1;
    primitive.targets = Array.from({ length: shapes }, () => ({ POSITION }));
  }
}

function paintAsToon(gltf: GltfJson): void {
  const json = gltf as Painted;
  json.extensionsUsed.push('VRMC_materials_mtoon');
  for (const material of json.materials) {
    material.extensions = {
      VRMC_materials_mtoon: {
        specVersion: '1.0',
        outlineWidthMode: 'worldCoordinates',
        outlineWidthFactor: 0.003,
        outlineColorFactor: [0.1, 0.05, 0.05],
        shadeColorFactor: [0.6, 0.5, 0.5],
        shadingToonyFactor: 0.9,
      },
    };
  }
}
