import { BufferAttribute, BufferGeometry } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import type { Decoders } from 'threepoint/files';
import { avatarLimits } from 'threepoint/internal';
import type { DracoRequest, DracoResponse } from './draco-worker';

const maxNumbers = avatarLimits.triangles * 3;

/** The timeout of a mesh [ms]. */
const timeoutMs = 20_000;

interface PendingMesh {
  resolve(answer: DracoResponse): void;
  reject(error: Error): void;
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
 * A Draco loader for GLTFLoader that decodes in a worker. The one of three.js starts its worker from a blob: URL, which
 * the content security policy forbids. The worker decodes meshes in order; it is started with the first and terminated
 * when none is pending.
 */
class DracoInWorker {
  readonly #pending: PendingMesh[] = [];
  #worker: Worker | null = null;
  #timeout: ReturnType<typeof setTimeout> | undefined;

  readonly preload = (): void => undefined;

  decodeDracoFile(...[packed, onLoad, ids, types, , onError]: DracoCall): void {
    this.#decode({ packed, ids, types, maxNumbers }).then(geometryOf).then(onLoad, onError);
  }

  #decode(mesh: DracoRequest): Promise<DracoResponse> {
    return new Promise((resolve, reject) => {
      this.#worker ??= this.#start();
      this.#pending.push({ resolve, reject });
      this.#worker.postMessage(mesh);
      if (this.#pending.length === 1) this.#restartTimeout();
    });
  }

  #start(): Worker {
    const worker = new Worker(new URL('./draco-worker.ts', import.meta.url), { type: 'module' });
    worker.addEventListener('message', ({ data }: MessageEvent<DracoResponse>) => {
      this.#pending.shift()?.resolve(data);
      if (this.#pending.length > 0) this.#restartTimeout();
      else this.#end();
    });
    worker.addEventListener('error', ({ message }) => this.#fail(`Draco: the decoder did not start (${message})`));
    return worker;
  }

  #restartTimeout(): void {
    clearTimeout(this.#timeout);
    this.#timeout = setTimeout(() => this.#fail('Draco: unpacking it takes too long'), timeoutMs);
  }

  #fail(reason: string): void {
    for (const { reject } of this.#pending.splice(0)) reject(new Error(reason));
    this.#end();
  }

  #end(): void {
    clearTimeout(this.#timeout);
    this.#worker?.terminate();
    this.#worker = null;
  }
}

function geometryOf(answer: DracoResponse): BufferGeometry {
  if ('broken' in answer) throw new Error(answer.broken);
  const geometry = new BufferGeometry();
  geometry.setIndex(new BufferAttribute(answer.index, 1));
  for (const [name, { array, itemSize }] of Object.entries(answer.attributes)) {
    geometry.setAttribute(name, new BufferAttribute(array, itemSize));
  }
  return geometry;
}

async function meshopt(loader: GLTFLoader): Promise<void> {
  const { MeshoptDecoder } = await import('three/addons/libs/meshopt_decoder.module.js');
  loader.setMeshoptDecoder(MeshoptDecoder);
}

/** Returns a loader with all decoders. */
export async function createDecodingLoader(): Promise<GLTFLoader> {
  const loader = new GLTFLoader();
  for (const decode of Object.values(decoders)) await decode(loader);
  return loader;
}

/** The decoders of compressed files by the name of their extension, loaded when a file needs them. */
export const decoders: Decoders = {
  EXT_meshopt_compression: meshopt,
  KHR_meshopt_compression: meshopt,
  async KHR_draco_mesh_compression(loader) {
    loader.setDRACOLoader(new DracoInWorker() as never);
  },
};
