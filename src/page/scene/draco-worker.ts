import type { TypedArray } from 'three';
import wasmAddress from 'three/addons/libs/draco/gltf/draco_decoder.wasm?url';
import makeDraco from 'three/addons/libs/draco/gltf/draco_wasm_wrapper.js';
import { reasonOf } from 'threepoint/core';

/** A request to decode a mesh: Draco's ids of its attributes, and the array type of each. */
export interface DracoRequest {
  readonly packed: ArrayBuffer;
  readonly ids: Readonly<Record<string, number>>;
  readonly types: Readonly<Record<string, string>>;
  /** The maximum number of vertices or indices of a mesh. */
  readonly maxNumbers: number;
}

interface UnpackedMesh {
  readonly index: Uint32Array<ArrayBuffer>;
  readonly attributes: Readonly<Record<string, UnpackedAttribute>>;
}

export type DracoResponse = UnpackedMesh | { readonly broken: string };

/** The component types of glTF: the name of the array, and Draco's name. */
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

/** Allocates bytes of Draco's memory, calls `write` and returns a copy of the bytes. */
function readFromMemory(module: Draco, bytes: number, write: (at: number) => void): ArrayBuffer {
  const at = module._malloc(bytes);
  write(at);
  const memory = module.HEAPF32.buffer.slice(at, at + bytes);
  module._free(at);
  return memory;
}

function unpack(module: Draco, { packed, ids, types, maxNumbers }: DracoRequest): UnpackedMesh {
  const decoder = new module.Decoder();
  const mesh = new module.Mesh();
  try {
    const status = decoder.DecodeArrayToMesh(new Int8Array(packed), packed.byteLength, mesh);
    if (!status.ok() || mesh.ptr === 0) throw new Error(`Draco: ${status.error_msg()}`);
    const [points, corners] = [mesh.num_points(), mesh.num_faces() * 3];
    if (Math.max(points, corners) > maxNumbers) throw new Error('Draco: it unpacks to more than an avatar may have');
    const index = readFromMemory(module, corners * 4, (at) => decoder.GetTrianglesUInt32Array(mesh, corners * 4, at));
    const attributes = Object.fromEntries(
      Object.entries(ids).map(([name, id]) => {
        const [Kind, dracoKind] = kinds[(types[name] ?? 'Float32Array') as keyof typeof kinds] ?? kinds.Float32Array;
        const attribute = decoder.GetAttributeByUniqueId(mesh, id);
        const itemSize = attribute.num_components();
        const bytes = points * itemSize * Kind.BYTES_PER_ELEMENT;
        const memory = readFromMemory(module, bytes, (at) =>
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
  self.postMessage({ broken: reasonOf(error) } satisfies DracoResponse);
}

function answer(module: Draco, question: DracoRequest): void {
  try {
    const { index, attributes } = unpack(module, question);
    const buffers = [index, ...Object.values(attributes).map(({ array }) => array)].map(({ buffer }) => buffer);
    self.postMessage({ index, attributes } satisfies DracoResponse, { transfer: buffers });
  } catch (error) {
    refuse(error);
  }
}

// Requests are answered in order.
self.addEventListener('message', ({ data }: MessageEvent<DracoRequest>) => {
  draco.then((module) => answer(module, data), refuse);
});
