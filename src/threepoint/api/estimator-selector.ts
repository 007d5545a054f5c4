import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import { reasonOf } from '../core/errors/reasons';
import { type NetworkName, needsRegressor, networkOf } from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { type EstimatorName, estimatorNames, type PoseEstimator } from '../core/estimation/pose-estimator';
import type { TrackingFrame } from '../core/tracking/tracking-frame';

interface EstimatorSelectorOptions {
  /** The estimator to start with; no callback is called before the constructor has returned. */
  readonly estimator: EstimatorName;
  readonly calibration: Calibration;
  create(name: EstimatorName, calibration: Calibration, regressor: PoseRegressor | null): PoseEstimator;
  /** Loads a network; rejects with a sentence that names the file and its fault. */
  load(name: NetworkName): Promise<PoseRegressor>;
  /** Called when another estimator is in use, or when one has become unavailable. */
  onChange(): void;
  /** Called when a network is unavailable: inverse kinematics draws instead. */
  onUnavailable(name: NetworkName, reason: string): void;
}

/** Holds the selected estimator, or inverse kinematics until its network has loaded and after it failed. */
export class EstimatorSelector {
  readonly #options: EstimatorSelectorOptions;
  readonly #loading = new Map<NetworkName, Promise<PoseRegressor>>();
  readonly #unavailable: Partial<Record<EstimatorName, string>> = {};
  #calibration: Calibration;
  #selected: EstimatorName;
  #current: PoseEstimator;
  #regressor: PoseRegressor | null = null;
  #disposed = false;
  /** The number of changes and resets of the estimator so far. */
  #changes = 0;

  constructor(options: EstimatorSelectorOptions) {
    this.#options = options;
    this.#calibration = options.calibration;
    this.#selected = options.estimator;
    const loads = networkOf(this.#selected) !== null;
    this.#current = this.#create(loads ? 'ik' : this.#selected, null);
    if (loads) void this.setEstimator(this.#selected);
  }

  get current(): PoseEstimator {
    return this.#current;
  }

  /** The selected estimator, which may still be loading. */
  get selected(): EstimatorName {
    return this.#selected;
  }

  /** The network behind the current estimator; null: it has none. */
  get regressor(): PoseRegressor | null {
    return this.#regressor;
  }

  get unavailable(): Partial<Readonly<Record<EstimatorName, string>>> {
    return this.#unavailable;
  }

  /**
   * Selects the estimator. Resolves when it draws, or when it has turned out to be unavailable. Rejects with a
   * RangeError, without any change, where no estimator has this name; else only with what a callback throws.
   */
  async setEstimator(name: EstimatorName): Promise<void> {
    if (this.#disposed || this.#unavailable[name] !== undefined) return;
    const needed = networkOf(name);
    if (needed) {
      this.#selected = name;
      return this.#selectWithNetwork(name, needed);
    }
    this.#switchTo(name, null);
    this.#selected = name;
    this.#options.onChange();
  }

  async #selectWithNetwork(name: EstimatorName, needed: NetworkName): Promise<void> {
    let network: PoseRegressor | null = null;
    if (this.#unavailable[needed] === undefined) {
      try {
        network = await this.#network(needed);
        // A page may supply the network of another estimator by mistake: creating the estimator throws then.
        this.#create(needed, network);
      } catch (error) {
        this.#markUnavailable(needed, error);
      }
    }
    // Another estimator may have been selected meanwhile, or the network may have failed.
    if (this.#disposed || this.#selected !== name) return;
    this.#switchTo(name, this.#unavailable[needed] === undefined ? network : null);
    this.#options.onChange();
  }

  /** Sets the measures for every estimator, from the next frame on. */
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
   * Runs a new estimator of the current method over these frames, awaiting each answer of its network, and draws with
   * it from then on. Calls `then` with the pose of the last frame. Has no effect if the estimator was changed or reset
   * meanwhile.
   */
  async warmUp(frames: Iterable<TrackingFrame>, then: (pose: AvatarPose) => void): Promise<void> {
    this.#changes += 1;
    const changes = this.#changes;
    const warmed = this.#create(this.#current.name, this.#regressor);
    let last: AvatarPose | null = null;
    for (const frame of frames) {
      const { pose, request } = warmed.update(frame);
      // A network that answers within its frame is not awaited: all frames are processed at once.
      if (request) await request.ask();
      if (this.#changes !== changes) return;
      last = pose;
    }
    if (!last) return;
    this.#current = warmed;
    then(last);
  }

  /** Replaces an estimator whose network has failed in the newest frame. */
  check(): void {
    const fault = this.#current.fault();
    const network = networkOf(this.#current.name);
    if (fault !== null && network !== null) this.#markUnavailable(network, fault);
  }

  /**
   * Releases every network that was loaded or is still loading; rejects where one cannot be released. No callback is
   * called afterwards.
   */
  async dispose(): Promise<void> {
    this.#disposed = true;
    this.#changes += 1;
    this.#current = this.#create('ik', null);
    this.#regressor = null;
    const loaded = await Promise.allSettled(this.#loading.values());
    const disposals = loaded.map((load) => (load.status === 'fulfilled' ? load.value.dispose() : null));
    await Promise.allSettled(disposals);
    await Promise.all(disposals);
  }

  #create(name: EstimatorName, network: PoseRegressor | null): PoseEstimator {
    return this.#options.create(name, this.#calibration, network);
  }

  /** Uses this method and network from now on. If both are the same as before, the estimator keeps its state. */
  #switchTo(name: EstimatorName, network: PoseRegressor | null): void {
    if (this.#current.name === name && this.#regressor === network) return;
    this.#current = this.#create(name, network);
    this.#changes += 1;
    this.#regressor = network;
  }

  /**
   * Replaces an estimator whose network failed: by the same method if it works without a network, else by inverse
   * kinematics.
   */
  #markUnavailable(network: NetworkName, error: unknown): void {
    if (this.#disposed || this.#unavailable[network] !== undefined) return;
    const reason = reasonOf(error);
    const isLost = (name: EstimatorName) => needsRegressor(name) && networkOf(name) === network;
    for (const lost of estimatorNames.filter(isLost)) this.#unavailable[lost] = reason;
    const { name } = this.#current;
    const isSelected = isLost(this.#selected);
    if (isSelected) this.#selected = 'ik';
    if (isSelected && name !== 'ik') this.#switchTo('ik', null);
    else if (this.#regressor && networkOf(name) === network) this.#switchTo(needsRegressor(name) ? 'ik' : name, null);
    this.#options.onUnavailable(network, reason);
    this.#options.onChange();
  }

  #network(name: NetworkName): Promise<PoseRegressor> {
    const network = this.#loading.get(name) ?? this.#load(name);
    this.#loading.set(name, network);
    return network;
  }

  /** Loads a network; exceptions become rejections. */
  #load(name: NetworkName): Promise<PoseRegressor> {
    try {
      return this.#options.load(name);
    } catch (error) {
      return Promise.reject(error);
    }
  }
}
