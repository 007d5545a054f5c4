import { reasonOf } from '../core/errors/reasons';
import type { ModelContract, PoseRegressor } from '../core/estimation/pose-regressor';
import { named } from './model-files';
import type { InferenceSession } from './session';

/** What takes over from a session whose graphics device fails. */
export interface Takeover {
  /** Opens the network in WebAssembly. */
  open(): Promise<InferenceSession>;
  /** Why WebGPU was left, once WebAssembly runs. */
  onTakeover?(reason: string): void;
}

/** A run of a device that is lost may fail so long [ms] before the browser says that it is. */
const lossPatienceMs = 1000;

/** Why the device of this session is gone; null: it does not turn out to be. */
async function lossOf({ lost }: InferenceSession): Promise<string | null> {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const inVain = new Promise<null>((resolve) => {
    timer = setTimeout(resolve, lossPatienceMs, null);
  });
  try {
    return await Promise.race([lost ?? null, inVain]);
  } finally {
    clearTimeout(timer);
  }
}

/** A network in a session of the runtime: on a graphics device, and where that fails in WebAssembly. */
export class SessionRegressor implements PoseRegressor {
  readonly contract: ModelContract;
  readonly #takeover: Takeover;
  #session: InferenceSession;
  /** WebAssembly, from when it is asked for. */
  #next: Promise<InferenceSession> | null = null;
  #disposed = false;

  constructor(contract: ModelContract, session: InferenceSession, takeover: Takeover) {
    this.contract = contract;
    this.#session = session;
    this.#takeover = takeover;
  }

  get provider(): string {
    return this.#disposed ? 'none' : this.#session.provider;
  }

  async run(features: Float32Array): Promise<Float32Array> {
    this.#demand();
    if (this.#next) return (await this.#next).run(features);
    const session = this.#session;
    if (session.provider === 'wasm') return session.run(features);
    try {
      return await session.run(features);
    } catch (error) {
      this.#demand();
      this.#next ??= this.#leave(session, error);
      return (await this.#next).run(features);
    }
  }

  async dispose(): Promise<void> {
    if (this.#disposed) return;
    this.#disposed = true;
    await this.#session.release();
    // What still opens lets itself go.
    await Promise.allSettled([this.#next]);
  }

  async #leave(device: InferenceSession, error: unknown): Promise<InferenceSession> {
    const { file } = this.contract;
    const opened = await this.#takeover.open().catch((second: unknown) => {
      throw named(file, second);
    });
    if (this.#disposed) await opened.release();
    this.#demand();
    this.#session = opened;
    void this.#tell(device, error);
    return opened;
  }

  async #tell(device: InferenceSession, error: unknown): Promise<void> {
    const loss = await lossOf(device);
    if (this.#disposed) return;
    const what =
      loss === null
        ? `WebGPU failed at ${this.contract.file} (${reasonOf(error)})`
        : `The graphics device was lost (${loss})`;
    this.#takeover.onTakeover?.(`${what}: WebAssembly takes over.`);
  }

  /** Throws where the network was let go. */
  #demand(): void {
    if (this.#disposed) throw new Error(`${this.contract.file}: already disposed of`);
  }
}
