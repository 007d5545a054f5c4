import { BufferAttribute, BufferGeometry } from 'three';
import type { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { avatarLimits } from '../file/avatar-limits';
import type { Decoders } from '../load-avatar';
import type { DracoAnswer, DracoQuestion } from './draco-worker';
import { WorkerClient } from './worker-client';

const mostNumbers = avatarLimits.triangles * 3;

type DracoWorker = WorkerClient<DracoQuestion, DracoAnswer>;

async function geometryOf(worker: DracoWorker, question: DracoQuestion): Promise<BufferGeometry> {
  const answer = await worker.request(question);
  if ('broken' in answer) throw new Error(answer.broken);
  const geometry = new BufferGeometry();
  geometry.setIndex(new BufferAttribute(answer.index, 1));
  for (const [name, { array, itemSize }] of Object.entries(answer.attributes)) {
    geometry.setAttribute(name, new BufferAttribute(array, itemSize));
  }
  return geometry;
}

/** How GLTFLoader asks a Draco loader for a mesh. */
type DracoCall = [
  packed: ArrayBuffer,
  onLoad: (geometry: BufferGeometry) => void,
  ids: Record<string, number>,
  types: Record<string, string>,
  colourSpace: string,
  onError: (error: unknown) => void,
];

/**
 * What GLTFLoader asks of a Draco loader, answered by a worker of our own: three.js's own starts from a blob: address,
 * which our policy forbids.
 */
function dracoInWorker() {
  const worker: DracoWorker = new WorkerClient(
    'Draco',
    () => new Worker(new URL('./draco-worker.ts', import.meta.url), { type: 'module' }),
  );
  return {
    preload: () => undefined,
    decodeDracoFile(...[packed, onLoad, ids, types, , onError]: DracoCall): void {
      geometryOf(worker, { packed, ids, types, mostNumbers }).then(onLoad, onError);
    },
  };
}

async function meshopt(loader: GLTFLoader): Promise<void> {
  const { MeshoptDecoder } = await import('three/addons/libs/meshopt_decoder.module.js');
  loader.setMeshoptDecoder(MeshoptDecoder);
}

/**
 * Compressions that a page unpacks, by the name of their extension: what gives a loader the means, fetched when a file
 * needs it.
 */
export const decoders: Decoders = {
  EXT_meshopt_compression: meshopt,
  KHR_meshopt_compression: meshopt,
  async KHR_draco_mesh_compression(loader) {
    loader.setDRACOLoader(dracoInWorker() as never);
  },
};
