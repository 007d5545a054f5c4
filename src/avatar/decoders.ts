import { BufferAttribute, BufferGeometry } from 'three';
import type { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import type { DracoAnswer, DracoQuestion } from './draco-worker';
import { avatarLimits } from './inspect-avatar';
import type { Decoders } from './load-avatar';

/** A decoder that is silent for longer [ms] is not worth the wait. */
const patienceMs = 20_000;
const mostNumbers = avatarLimits.triangles * 3;

interface Waiting {
  resolve(answer: DracoAnswer): void;
  reject(error: Error): void;
}

/** A worker that unpacks meshes in the order in which they are asked for. It begins with the first and ends when none is left. */
class DracoWorker {
  readonly #waiting: Waiting[] = [];
  #worker: Worker | null = null;
  #patience: ReturnType<typeof setTimeout> | undefined;

  ask(question: DracoQuestion): Promise<DracoAnswer> {
    return new Promise((resolve, reject) => {
      this.#worker ??= this.#begin();
      this.#waiting.push({ resolve, reject });
      this.#worker.postMessage(question);
      if (this.#waiting.length === 1) this.#wait();
    });
  }

  #begin(): Worker {
    const worker = new Worker(new URL('./draco-worker.ts', import.meta.url), { type: 'module' });
    worker.addEventListener('message', ({ data }: MessageEvent<DracoAnswer>) => {
      this.#waiting.shift()?.resolve(data);
      if (this.#waiting.length > 0) this.#wait();
      else this.#end();
    });
    worker.addEventListener('error', ({ message }) => this.#fail(`Draco: the decoder did not start (${message})`));
    return worker;
  }

  #wait(): void {
    clearTimeout(this.#patience);
    this.#patience = setTimeout(() => this.#fail('Draco: unpacking it takes too long'), patienceMs);
  }

  #fail(reason: string): void {
    for (const { reject } of this.#waiting.splice(0)) reject(new Error(reason));
    this.#end();
  }

  #end(): void {
    clearTimeout(this.#patience);
    this.#worker?.terminate();
    this.#worker = null;
  }
}

async function geometryOf(worker: DracoWorker, question: DracoQuestion): Promise<BufferGeometry> {
  const answer = await worker.ask(question);
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
function dracoInWorker() {
  const worker = new DracoWorker();
  return {
    preload: () => undefined,
    decodeDracoFile(...[packed, onLoad, ids, types, , onError]: DracoCall): void {
      geometryOf(worker, { packed, ids, types, mostNumbers }).then(onLoad, onError);
    },
  };
}

async function meshopt(loader: GLTFLoader): Promise<void> {
  const { MeshoptDecoder } = await import('three/examples/jsm/libs/meshopt_decoder.module.js');
  loader.setMeshoptDecoder(MeshoptDecoder);
}

/** Compressions that a page unpacks, by the name of their extension: what gives a loader the means, fetched when a file needs it. */
export const decoders: Decoders = {
  EXT_meshopt_compression: meshopt,
  KHR_meshopt_compression: meshopt,
  async KHR_draco_mesh_compression(loader) {
    loader.setDRACOLoader(dracoInWorker() as never);
  },
};
