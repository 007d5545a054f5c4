import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import { reasonOf } from '../core/errors/reasons';
import { type NetworkName, needsRegressor, networkOf } from '../core/estimation/estimators';
import type { EstimatorName, PoseEstimator } from '../core/estimation/pose-estimator';
import type { PoseRegressor } from '../core/estimation/pose-regressor';
import type { TrackingFrame } from '../core/tracking/tracking-frame';

export interface EstimatorChoiceOptions {
  /** What is wanted first; nothing is told of it before this has been made. */
  readonly estimator: EstimatorName;
  readonly calibration: Calibration;
  create(name: EstimatorName, calibration: Calibration, regressor?: PoseRegressor): PoseEstimator;
  /** Rejects with a sentence that names the file and what is wrong with it. */
  load(name: NetworkName): Promise<PoseRegressor>;
  /** Another estimator draws from now on, or one has become unavailable. */
  onChange(): void;
  /** This network is not to be had: inverse kinematics draws instead. */
  onFault(name: NetworkName, reason: string): void;
}

/** Which estimator draws. There is always one: until a network is loaded, or when it fails, it is inverse kinematics. */
export class EstimatorChoice {
  readonly #options: EstimatorChoiceOptions;
  readonly #loading = new Map<NetworkName, Promise<PoseRegressor>>();
  readonly #unavailable: Partial<Record<EstimatorName, string>> = {};
  #calibration: Calibration;
  #wanted: EstimatorName;
  #current: PoseEstimator;
  #regressor: PoseRegressor | null = null;
  #disposed = false;
  /** How often what draws has changed or forgotten. */
  #changes = 0;

  constructor(options: EstimatorChoiceOptions) {
    this.#options = options;
    this.#calibration = options.calibration;
    this.#wanted = options.estimator;
    const loads = networkOf(this.#wanted) !== null;
    this.#current = this.#make(loads ? 'ik' : this.#wanted, null);
    if (loads) void this.setEstimator(this.#wanted);
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

  /**
   * Resolves when this estimator draws, or when it turned out that it cannot. Rejects with a RangeError where there is none of this name, and changes
   * nothing; else only with what a listener throws.
   */
  async setEstimator(name: EstimatorName): Promise<void> {
    if (this.#disposed || this.#unavailable[name] !== undefined) return;
    const needed = networkOf(name);
    if (needed) {
      this.#wanted = name;
      return this.#chooseWith(name, needed);
    }
    this.#drawWith(name, null);
    this.#wanted = name;
    this.#options.onChange();
  }

  async #chooseWith(name: EstimatorName, needed: NetworkName): Promise<void> {
    let network: PoseRegressor | null = null;
    if (this.#unavailable[needed] === undefined) {
      try {
        network = await this.#network(needed);
        // What a page brings may be another method's: then it cannot be had, which is no matter of who chose it.
        this.#make(needed, network);
      } catch (error) {
        this.#giveUp(needed, error);
      }
    }
    // While it loaded, the user may have thought of something else, or it may have failed at its first run.
    if (this.#disposed || this.#wanted !== name) return;
    this.#drawWith(name, this.#unavailable[needed] === undefined ? network : null);
    this.#options.onChange();
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
  async warmUp(frames: Iterable<TrackingFrame>, then: (pose: AvatarPose) => void): Promise<void> {
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

  /** Gives up on a network that has failed while running; call it now and then. */
  check(): void {
    const fault = this.#current.fault();
    const network = networkOf(this.#current.name);
    if (fault !== null && network !== null) this.#giveUp(network, fault);
  }

  /** Lets every network go that was loaded, and those that still arrive; rejects where one cannot be. Nothing is told from then on. */
  async dispose(): Promise<void> {
    this.#disposed = true;
    this.#changes += 1;
    this.#current = this.#make('ik', null);
    this.#regressor = null;
    const arrived = await Promise.allSettled(this.#loading.values());
    const goes = arrived.map((arriving) => (arriving.status === 'fulfilled' ? arriving.value.dispose() : null));
    await Promise.allSettled(goes);
    await Promise.all(goes);
  }

  #make(name: EstimatorName, network: PoseRegressor | null): PoseEstimator {
    const { create } = this.#options;
    return network ? create(name, this.#calibration, network) : create(name, this.#calibration);
  }

  /** What draws so already goes on: it has noticed how the hands are held. */
  #drawWith(name: EstimatorName, network: PoseRegressor | null): void {
    if (this.#current.name === name && this.#regressor === network) return;
    this.#current = this.#make(name, network);
    this.#changes += 1;
    this.#regressor = network;
  }

  /** What draws with this network goes on without where it can; else, and where the network was wanted next, inverse kinematics does. */
  #giveUp(network: NetworkName, error: unknown): void {
    if (this.#disposed || this.#unavailable[network] !== undefined) return;
    const reason = reasonOf(error);
    this.#unavailable[network] = reason;
    const { name } = this.#current;
    const wanted = this.#wanted === network;
    if (wanted) this.#wanted = 'ik';
    if (wanted && name !== 'ik') this.#drawWith('ik', null);
    else if (this.#regressor && networkOf(name) === network) this.#drawWith(needsRegressor(name) ? 'ik' : name, null);
    this.#options.onFault(network, reason);
    this.#options.onChange();
  }

  #network(name: NetworkName): Promise<PoseRegressor> {
    const known = this.#loading.get(name);
    if (known) return known;
    const started = this.#load(name);
    this.#loading.set(name, started);
    return started;
  }

  /** Rejects also with what is thrown at once. */
  #load(name: NetworkName): Promise<PoseRegressor> {
    try {
      return this.#options.load(name);
    } catch (error) {
      return Promise.reject(error);
    }
  }
}
