import { BufferAttribute, BufferGeometry } from 'three';
import type { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { avatarLimits } from '../file/avatar-limits';
import type { Decoders } from '../load-avatar';
import type { DracoRequest, DracoResponse } from './draco-worker';
import { WorkerClient } from './worker-client';

const maxNumbers = avatarLimits.triangles * 3;

type DracoWorker = WorkerClient<DracoRequest, DracoResponse>;

async function geometryOf(worker: DracoWorker, question: DracoRequest): Promise<BufferGeometry> {
  const answer = await worker.request(question);
  if ('broken' in answer) throw new Error(answer.broken);
  const geometry = new BufferGeometry();
  geometry.setIndex(new BufferAttribute(answer.index, 1));
  for (const [name, { array, itemSize }] of Object.entries(answer.attributes)) {
    geometry.setAttribute(name, new BufferAttribute(array, itemSize));
  }
  return geometry;
}

/** The arguments with which GLTFLoader calls a Draco loader. */
type DracoCall = [
  packed: ArrayBuffer,
  onLoad: (geometry: BufferGeometry) => void,
  ids: Record<string, number>,
  types: Record<string, string>,
  colourSpace: string,
  onError: (error: unknown) => void,
];

/**
 * Returns a Draco loader for GLTFLoader that decodes in a worker. The one of three.js starts its worker from a blob:
 * URL, which the content security policy forbids.
 */
function dracoInWorker() {
  const worker: DracoWorker = new WorkerClient(
    'Draco',
    () => new Worker(new URL('./draco-worker.ts', import.meta.url), { type: 'module' }),
  );
  return {
    preload: () => undefined,
    decodeDracoFile(...[packed, onLoad, ids, types, , onError]: DracoCall): void {
      geometryOf(worker, { packed, ids, types, maxNumbers }).then(onLoad, onError);
    },
  };
}

async function meshopt(loader: GLTFLoader): Promise<void> {
  const { MeshoptDecoder } = await import('three/addons/libs/meshopt_decoder.module.js');
  loader.setMeshoptDecoder(MeshoptDecoder);
}

/** The decoders of compressed files by the name of their extension, loaded when a file needs them. */
export const decoders: Decoders = {
  EXT_meshopt_compression: meshopt,
  KHR_meshopt_compression: meshopt,
  async KHR_draco_mesh_compression(loader) {
    loader.setDRACOLoader(dracoInWorker() as never);
  },
};
