import type { WebGLRenderer } from 'three';
import basisAddress from 'three/examples/jsm/libs/basis/basis_transcoder.wasm?url';
import type { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { KTX2Loader } from 'three/examples/jsm/loaders/KTX2Loader.js';
import { reasonOf } from '../../core/errors/reasons';
import { WorkerClient } from './worker-client';

/** What three.js's worker answers; without `data`: why not. */
interface TranscodeAnswer {
  readonly type: 'transcode' | 'error';
  readonly error?: unknown;
}

/** Which compressed pictures this device draws. A page of one device draws by one context as by the other. */
function detectFormats(loader: KTX2Loader): void {
  const context = document.createElement('canvas').getContext('webgl2');
  const extensions = {
    has: (name: string) => Boolean(context?.getExtension(name)),
    get: (name: string) => context?.getExtension(name),
  };
  loader.detectSupport({ extensions } as unknown as WebGLRenderer);
  context?.getExtension('WEBGL_lose_context')?.loseContext();
}

/** three.js's loader of KTX2, whose worker is a file of our own: its own starts from a blob: address and compiles text, which our policy forbids. */
class Ktx2InWorker extends KTX2Loader {
  /** The fault of the first picture that could not be decoded: GLTFLoader continues without it. */
  fault: Error | null = null;
  readonly #worker = new WorkerClient<object, TranscodeAnswer>('KTX2', () => {
    const worker = new Worker(new URL('./ktx2-worker.ts', import.meta.url), { type: 'module' });
    worker.postMessage({ type: 'init', config: this.workerConfig, transcoderBinary: this.transcoderBinary });
    return worker;
  });

  constructor() {
    super();
    detectFormats(this);
    this.workerPool = {
      postMessage: async (question: object, transfer: Transferable[]) => {
        const data = await this.#worker.request(question, transfer);
        if (data.type === 'error') throw new Error(`KTX2: ${reasonOf(data.error)}`);
        return { data };
      },
    } as never;
  }

  override async init(): Promise<void> {
    this.transcoderBinary ??= await (await fetch(basisAddress)).arrayBuffer();
  }

  override parse(...[buffer, onLoad, onError]: Parameters<KTX2Loader['parse']>): void {
    super.parse(buffer, onLoad, (error) => {
      this.fault ??= error instanceof Error ? error : new Error(String(error));
      onError?.(error);
    });
  }
}

/** Gives a loader the means to unpack KTX2 pictures; a file with one that cannot be unpacked is refused. */
export function unpackKtx2(loader: GLTFLoader): void {
  const ktx2 = new Ktx2InWorker();
  loader.setKTX2Loader(ktx2);
  loader.register(() => ({
    name: 'threepoint_ktx2',
    async afterRoot() {
      if (ktx2.fault) throw ktx2.fault;
    },
  }));
}
