import { BufferAttribute, BufferGeometry } from 'three';
import type { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import type { DracoAnswer, DracoQuestion } from './draco-worker';
import { avatarLimits } from './inspect-avatar';
import type { Decoders } from './load-avatar';

/** A mesh that keeps the decoder busy for longer [ms] is not worth the wait. */
const patienceMs = 20_000;
const mostNumbers = avatarLimits.triangles * 3;

function askWorker(question: DracoQuestion): Promise<DracoAnswer> {
  const worker = new Worker(new URL('./draco-worker.ts', import.meta.url), { type: 'module' });
  return new Promise<DracoAnswer>((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error('Draco: unpacking it takes too long')), patienceMs);
    worker.addEventListener('message', ({ data }: MessageEvent<DracoAnswer>) => {
      clearTimeout(timer);
      resolve(data);
    });
    worker.addEventListener('error', ({ message }) => {
      clearTimeout(timer);
      reject(new Error(`Draco: the decoder did not start (${message})`));
    });
    worker.postMessage(question);
  }).finally(() => worker.terminate());
}

async function geometryOf(question: DracoQuestion): Promise<BufferGeometry> {
  const answer = await askWorker(question);
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

/** What GLTFLoader asks of a Draco loader, answered by a worker of our own: three.js's own starts from a blob: address, which our policy forbids. */
const dracoInWorker = {
  preload: () => undefined,
  decodeDracoFile(...[packed, onLoad, ids, types, , onError]: DracoCall): void {
    geometryOf({ packed, ids, types, mostNumbers }).then(onLoad, onError);
  },
};

async function meshopt(loader: GLTFLoader): Promise<void> {
  const { MeshoptDecoder } = await import('three/examples/jsm/libs/meshopt_decoder.module.js');
  loader.setMeshoptDecoder(MeshoptDecoder);
}

/** Compressions that a page unpacks, by the name of their extension: what gives a loader the means, fetched when a file needs it. */
export const decoders: Decoders = {
  EXT_meshopt_compression: meshopt,
  KHR_meshopt_compression: meshopt,
  async KHR_draco_mesh_compression(loader) {
    loader.setDRACOLoader(dracoInWorker as never);
  },
};
