import { type Mesh, type MeshStandardMaterial, Texture } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { describe, expect, test, vi } from 'vitest';
import { blobBufferViews } from '../../../src/threepoint/avatar/file/blob-buffer-views';
import { readGlbChunks } from '../../../src/threepoint/avatar/file/glb-chunks';
import { glbOf, padded } from './glb';

const places = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0.25, 0.5, -2]);
const corners = new Uint16Array([0, 1, 2, 2, 1, 3]);
/**
 * Returns bytes that differ from their neighbours, so that a view that is off by one byte is noticed; their number is
 * no multiple of a word.
 */
const bytesFrom = (first: number, length: number) => Uint8Array.from({ length }, (_, i) => (first + i * 7) & 255);
const skin = bytesFrom(11, 301);
const cloth = bytesFrom(83, 77);

/** A square with two pictures. */
function paintedSquare(): ArrayBuffer {
  const parts = [places, corners, skin, cloth].map(
    ({ buffer, byteOffset, byteLength }) => new Uint8Array(buffer, byteOffset, byteLength),
  );
  const starts = parts.map((_, i) => parts.slice(0, i).reduce((sum, { length }) => sum + padded(length), 0));
  const binary = new Uint8Array(parts.reduce((sum, { length }) => sum + padded(length), 0));
  for (const [i, part] of parts.entries()) binary.set(part, starts[i]);
  const json = {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1, material: 0 }] }],
    materials: [
      {
        pbrMetallicRoughness: { baseColorTexture: { index: 0 } },
        emissiveTexture: { index: 1 },
      },
    ],
    textures: [{ source: 0 }, { source: 1 }],
    images: [
      { bufferView: 2, mimeType: 'image/png' },
      { bufferView: 3, mimeType: 'image/jpeg' },
    ],
    accessors: [
      { bufferView: 0, componentType: 5126, type: 'VEC3', count: 4, min: [0, 0, -2], max: [1, 1, 0] },
      { bufferView: 1, componentType: 5123, type: 'SCALAR', count: 6 },
    ],
    // A first view may leave out that it begins at 0.
    bufferViews: parts.map(({ length }, i) => ({
      buffer: 0,
      byteLength: length,
      ...(i > 0 && { byteOffset: starts[i] }),
    })),
    buffers: [{ byteLength: binary.length }],
  };
  return glbOf(json, binary);
}

/** What a page's decoder of a picture was given. */
interface Picture extends Texture {
  given: { readonly bytes: Uint8Array; readonly type: string };
}

function pictureOf(bytes: ArrayBuffer, type: string): Picture {
  return Object.assign(new Texture(), { given: { bytes: new Uint8Array(bytes), type } });
}

/** Reads pictures as a browser does, by their address, but keeps their bytes where a browser would decode them. */
function readPicture(
  address: string,
  onLoad: (picture: Texture) => void,
  _: unknown,
  onError: (error: unknown) => void,
) {
  fetch(address)
    .then(async (answer) => pictureOf(await answer.arrayBuffer(), answer.headers.get('content-type') ?? ''))
    .then(onLoad, onError);
}

/** Returns the loader's result for a file, and whether its parser was asked for the whole binary. */
async function loaded(file: ArrayBuffer) {
  // The loader asks the window for addresses of blobs.
  vi.stubGlobal('self', globalThis);
  const { json, binary } = readGlbChunks(new Uint8Array(file))!;
  const loader = new GLTFLoader();
  loader.register(blobBufferViews(new Blob([binary as Uint8Array<ArrayBuffer>])));
  loader.register((parser) => {
    parser.textureLoader = { load: readPicture } as never;
    vi.spyOn(parser, 'loadBuffer');
    return { name: 'pictures as bytes' };
  });
  const { scene, parser } = await loader.parseAsync(json, '');
  const { geometry, material } = scene.children[0] as Mesh;
  return { parser, geometry, material: material as MeshStandardMaterial };
}

describe('a file that is read in views', () => {
  test('gives each picture the very bytes that it has in the file, and their type', async () => {
    const { material } = await loaded(paintedSquare());
    expect((material.map as Picture).given).toEqual({ bytes: skin, type: 'image/png' });
    expect((material.emissiveMap as Picture).given).toEqual({ bytes: cloth, type: 'image/jpeg' });
  });

  test('cuts meshes out as they are, each into memory of its own', async () => {
    const { geometry } = await loaded(paintedSquare());
    expect(geometry.getAttribute('position').array).toEqual(places);
    expect(geometry.getIndex()?.array).toEqual(corners);
    expect(geometry.getAttribute('position').array.buffer.byteLength).toBe(places.byteLength);
  });

  test('copies nothing as a whole, unless a reader of packed meshes asks for it', async () => {
    const file = paintedSquare();
    const { parser } = await loaded(file);
    expect(parser.loadBuffer).not.toHaveBeenCalled();
    const whole: ArrayBuffer = await parser.getDependency('buffer', 0);
    expect(new Uint8Array(whole)).toEqual(readGlbChunks(new Uint8Array(file))!.binary);
  });
});
