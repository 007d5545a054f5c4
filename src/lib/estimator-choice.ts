import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import { reasonOf } from '../core/errors/reasons';
import { type NetworkName, needsRegressor, networkOf } from '../core/estimation/estimators';
import type { EstimatorName, PoseEstimator } from '../core/estimation/pose-estimator';
import type { PoseRegressor } from '../core/estimation/pose-regressor';
import type { TrackingFrame } from '../core/tracking/tracking-frame';

export interface EstimatorChoiceOptions {
  readonly calibration: Calibration;
  create(name: EstimatorName, calibration: Calibration, regressor?: PoseRegressor): PoseEstimator;
  /** Rejects with a sentence that names the file and what is wrong with it. */
  load(name: NetworkName): Promise<PoseRegressor>;
  /** Another estimator draws from now on, or one has become unavailable. */
  onChange(): void;
  /** What was chosen is not to be had: inverse kinematics draws instead. */
  onFault(name: EstimatorName, reason: string): void;
}

/** Which estimator draws. There is always one: until a network is loaded, or when it fails, it is inverse kinematics. */
export class EstimatorChoice {
  readonly #options: EstimatorChoiceOptions;
  readonly #loading = new Map<NetworkName, Promise<PoseRegressor>>();
  readonly #unavailable: Partial<Record<EstimatorName, string>> = {};
  #calibration: Calibration;
  #wanted: EstimatorName = 'ik';
  #current: PoseEstimator;
  #regressor: PoseRegressor | null = null;
  #disposed = false;
  /** How often what draws has changed or forgotten. */
  #changes = 0;

  constructor(options: EstimatorChoiceOptions) {
    this.#options = options;
    this.#calibration = options.calibration;
    this.#current = this.#make('ik', null);
  }

  get current(): PoseEstimator {
    return this.#current;
  }

  /** What the user wants, which may still be loading. */
  get wanted(): EstimatorName {
    return this.#wanted;
  }

  /** The network behind the current estimator; null: it has none. */
  get regressor(): PoseRegressor | null {
    return this.#regressor;
  }

  get unavailable(): Partial<Readonly<Record<EstimatorName, string>>> {
    return this.#unavailable;
  }

  /** Resolves when this estimator draws, or when it turned out that it cannot. Never rejects. */
  async choose(name: EstimatorName): Promise<void> {
    if (this.#disposed || this.#unavailable[name] !== undefined) return;
    this.#wanted = name;
    const needed = networkOf(name);
    if (needed === null) {
      this.#drawWith(name, null);
      return;
    }
    try {
      const loaded = await this.#network(needed);
      // While it loaded, the user may have thought of something else, or it may have failed at its first run.
      if (this.#isWanted(name) && this.#unavailable[name] === undefined) this.#drawWith(name, loaded);
    } catch (error) {
      if (needsRegressor(name)) this.#giveUp(name, error);
      else if (this.#isWanted(name)) this.#drawWith(name, null);
    }
  }

  /** For every estimator from the next frame on. */
  calibrate(calibration: Calibration): void {
    this.#calibration = calibration;
    this.#changes += 1;
    this.#current.calibrate(calibration);
  }

  reset(): void {
    this.#changes += 1;
    this.#current.reset();
  }

  /**
   * An estimator of the current method lives through these frames, each answer of its network waited for, and draws from then on; `then` hears
   * what it draws of the last. Not where another draws by then, or everything was forgotten.
   */
  async relive(frames: Iterable<TrackingFrame>, then: (pose: AvatarPose) => void): Promise<void> {
    this.#changes += 1;
    const begun = this.#changes;
    const living = this.#make(this.#current.name, this.#regressor);
    let lived: AvatarPose | null = null;
    for (const frame of frames) {
      const { pose, request } = living.update(frame);
      // What answers within its frame is not waited for: such a method has lived through all of them at once.
      if (request) await request.ask();
      if (this.#changes !== begun) return;
      lived = pose;
    }
    if (!lived) return;
    this.#current = living;
    then(lived);
  }

  /** Gives up on an estimator whose network has failed while running; call it now and then. */
  check(): void {
    const fault = this.#current.fault();
    if (fault !== null) this.#giveUp(this.#current.name, fault);
  }

  /** Lets every network go that was loaded, and those that still arrive. Nothing is told from then on. */
  async dispose(): Promise<void> {
    this.#disposed = true;
    this.#changes += 1;
    this.#current = this.#make('ik', null);
    this.#regressor = null;
    for (const arriving of await Promise.allSettled(this.#loading.values())) {
      if (arriving.status === 'fulfilled') await arriving.value.dispose();
    }
  }

  #isWanted(name: EstimatorName): boolean {
    return !this.#disposed && this.#wanted === name;
  }

  #make(name: EstimatorName, network: PoseRegressor | null): PoseEstimator {
    const { create } = this.#options;
    return network ? create(name, this.#calibration, network) : create(name, this.#calibration);
  }

  #drawWith(name: EstimatorName, network: PoseRegressor | null): void {
    this.#current = this.#make(name, network);
    this.#changes += 1;
    this.#regressor = network;
    this.#options.onChange();
  }

  #giveUp(name: EstimatorName, error: unknown): void {
    if (this.#disposed || this.#unavailable[name] !== undefined) return;
    this.#unavailable[name] = reasonOf(error);
    if (this.#wanted === name) this.#wanted = 'ik';
    if (this.#current.name === name) this.#drawWith('ik', null);
    this.#options.onFault(name, reasonOf(error));
    this.#options.onChange();
  }

  #network(name: NetworkName): Promise<PoseRegressor> {
    const known = this.#loading.get(name);
    if (known) return known;
    const started = this.#options.load(name);
    this.#loading.set(name, started);
    return started;
  }
}
