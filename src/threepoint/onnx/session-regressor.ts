import { reasonOf } from '../core/errors/reasons';
import type { EstimatorFactory, ModelContract, PoseRegressor } from '../core/estimation/networks/pose-regressor';
import type { PaperMethod } from '../core/estimation/pose-estimator';
import { withFileName } from './model-files';
import type { InferenceSession } from './session';

/** The time [ms] by which a failed run may precede the browser's report of a lost device. */
const lossPatienceMs = 1000;

/** Resolves with the reason why the session's device is lost; null: it is not. */
async function lossOf({ lost }: InferenceSession): Promise<string | null> {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const timeout = new Promise<null>((resolve) => {
    timer = setTimeout(resolve, lossPatienceMs, null);
  });
  try {
    return await Promise.race([lost ?? null, timeout]);
  } finally {
    clearTimeout(timer);
  }
}

/** Runs a network in a session of the runtime: on a graphics device, and where that fails in WebAssembly. */
export class SessionRegressor implements PoseRegressor {
  readonly contract: ModelContract;
  /** The methods of the paper, with the paper's network. */
  methods: Readonly<Record<PaperMethod, EstimatorFactory>> | undefined;
  readonly #openWasm: () => Promise<InferenceSession>;
  readonly #onTakeover: ((reason: string) => void) | undefined;
  #session: InferenceSession;
  /** The WebAssembly session, once it was requested. */
  #next: Promise<InferenceSession> | null = null;
  #disposed = false;

  /**
   * `openWasm`: opens the network in WebAssembly where the device of its session fails. `onTakeover`: called with the
   * reason, once it runs there.
   */
  constructor(
    contract: ModelContract,
    session: InferenceSession,
    openWasm: () => Promise<InferenceSession>,
    onTakeover?: (reason: string) => void,
  ) {
    this.contract = contract;
    this.#session = session;
    this.#openWasm = openWasm;
    this.#onTakeover = onTakeover;
  }

  get provider(): string {
    return this.#disposed ? 'none' : this.#session.provider;
  }

  async run(features: Float32Array): Promise<Float32Array> {
    this.#assertUsable();
    if (this.#next) return (await this.#next).run(features);
    const session = this.#session;
    if (session.provider === 'wasm') return session.run(features);
    try {
      return await session.run(features);
    } catch (error) {
      this.#assertUsable();
      this.#next ??= this.#leave(session, error);
      return (await this.#next).run(features);
    }
  }

  async dispose(): Promise<void> {
    if (this.#disposed) return;
    this.#disposed = true;
    await this.#session.release();
    // A session that is still opening releases itself.
    await Promise.allSettled([this.#next]);
  }

  async #leave(device: InferenceSession, error: unknown): Promise<InferenceSession> {
    const { file } = this.contract;
    const opened = await this.#openWasm().catch((second: unknown) => {
      throw withFileName(file, second);
    });
    if (this.#disposed) await opened.release();
    this.#assertUsable();
    this.#session = opened;
    void this.#reportLoss(device, error);
    return opened;
  }

  async #reportLoss(device: InferenceSession, error: unknown): Promise<void> {
    const loss = await lossOf(device);
    if (this.#disposed) return;
    const what =
      loss === null
        ? `WebGPU failed at ${this.contract.file} (${reasonOf(error)})`
        : `The graphics device was lost (${loss})`;
    this.#onTakeover?.(`${what}: WebAssembly takes over.`);
  }

  /** Throws where the network was released. */
  #assertUsable(): void {
    if (this.#disposed) throw new Error(`${this.contract.file}: used after dispose`);
  }
}
