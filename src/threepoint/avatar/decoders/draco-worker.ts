import type { TypedArray } from 'three';
import wasmAddress from 'three/addons/libs/draco/gltf/draco_decoder.wasm?url';
import makeDraco from 'three/addons/libs/draco/gltf/draco_wasm_wrapper.js';
import { reasonOf } from '../../core/errors/reasons';

/** One mesh to be unpacked: Draco's numbers of its attributes, and which kind of array each is to be. */
export interface DracoQuestion {
  readonly packed: ArrayBuffer;
  readonly ids: Readonly<Record<string, number>>;
  readonly types: Readonly<Record<string, string>>;
  /** The largest number of corners or triangles of a mesh, whatever its file declares. */
  readonly mostNumbers: number;
}

interface UnpackedMesh {
  readonly index: Uint32Array<ArrayBuffer>;
  readonly attributes: Readonly<Record<string, UnpackedAttribute>>;
}

export type DracoAnswer = UnpackedMesh | { readonly broken: string };

/** The kinds of numbers that glTF has, by three.js's names of their arrays, and Draco's names of them. */
const kinds = {
  Float32Array: [Float32Array, 'DT_FLOAT32'],
  Int8Array: [Int8Array, 'DT_INT8'],
  Int16Array: [Int16Array, 'DT_INT16'],
  Uint8Array: [Uint8Array, 'DT_UINT8'],
  Uint16Array: [Uint16Array, 'DT_UINT16'],
  Uint32Array: [Uint32Array, 'DT_UINT32'],
} as const;

interface UnpackedAttribute {
  readonly array: TypedArray & { readonly buffer: ArrayBuffer };
  readonly itemSize: number;
}

const draco = fetch(wasmAddress)
  .then((response) => response.arrayBuffer())
  .then((wasmBinary) => makeDraco({ wasmBinary }));

type Draco = Awaited<typeof draco>;

/** What `write` puts into so many bytes of Draco's memory. */
function taken(module: Draco, bytes: number, write: (at: number) => void): ArrayBuffer {
  const at = module._malloc(bytes);
  write(at);
  const memory = module.HEAPF32.buffer.slice(at, at + bytes);
  module._free(at);
  return memory;
}

function unpack(module: Draco, { packed, ids, types, mostNumbers }: DracoQuestion): UnpackedMesh {
  const decoder = new module.Decoder();
  const mesh = new module.Mesh();
  try {
    const status = decoder.DecodeArrayToMesh(new Int8Array(packed), packed.byteLength, mesh);
    if (!status.ok() || mesh.ptr === 0) throw new Error(`Draco: ${status.error_msg()}`);
    const [points, corners] = [mesh.num_points(), mesh.num_faces() * 3];
    if (Math.max(points, corners) > mostNumbers) throw new Error('Draco: it unpacks to more than an avatar may have');
    const index = taken(module, corners * 4, (at) => decoder.GetTrianglesUInt32Array(mesh, corners * 4, at));
    const attributes = Object.fromEntries(
      Object.entries(ids).map(([name, id]) => {
        const [Kind, dracoKind] = kinds[(types[name] ?? 'Float32Array') as keyof typeof kinds] ?? kinds.Float32Array;
        const attribute = decoder.GetAttributeByUniqueId(mesh, id);
        const itemSize = attribute.num_components();
        const bytes = points * itemSize * Kind.BYTES_PER_ELEMENT;
        const memory = taken(module, bytes, (at) =>
          decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, module[dracoKind], bytes, at),
        );
        return [name, { array: new Kind(memory), itemSize }];
      }),
    );
    return { index: new Uint32Array(index), attributes };
  } finally {
    module.destroy(mesh);
    module.destroy(decoder);
  }
}

function refuse(error: unknown): void {
  self.postMessage({ broken: reasonOf(error) } satisfies DracoAnswer);
}

function answer(module: Draco, question: DracoQuestion): void {
  try {
    const { index, attributes } = unpack(module, question);
    const buffers = [index, ...Object.values(attributes).map(({ array }) => array)].map(({ buffer }) => buffer);
    self.postMessage({ index, attributes } satisfies DracoAnswer, { transfer: buffers });
  } catch (error) {
    refuse(error);
  }
}

// One answer for each question, in their order.
self.addEventListener('message', ({ data }: MessageEvent<DracoQuestion>) => {
  draco.then((module) => answer(module, data), refuse);
});
