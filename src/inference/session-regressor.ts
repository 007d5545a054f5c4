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
    // A run may fail before its device is known to be lost.
    const what = device.loss
      ? `The graphics device was lost (${device.loss})`
      : `WebGPU failed at ${file} (${reasonOf(error)})`;
    this.#takeover.onTakeover?.(`${what}: WebAssembly takes over.`);
    return opened;
  }

  /** Throws where the network was let go. */
  #demand(): void {
    if (this.#disposed) throw new Error(`${this.contract.file}: already disposed of`);
  }
}
