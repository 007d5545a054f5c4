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
export interface EstimatorChoice {
  readonly current: PoseEstimator;
  /** What the user wants, which may still be loading. */
  readonly wanted: EstimatorName;
  /** The network behind the current estimator; null: it has none. */
  readonly regressor: PoseRegressor | null;
  readonly unavailable: Partial<Readonly<Record<EstimatorName, string>>>;
  /** Resolves when this estimator draws, or when it turned out that it cannot. Never rejects. */
  choose(name: EstimatorName): Promise<void>;
  /** For every estimator from the next frame on. */
  calibrate(calibration: Calibration): void;
  reset(): void;
  /**
   * An estimator of the current method lives through these frames, each answer of its network waited for, and draws from then on; `then` hears
   * what it draws of the last. Not where another draws by then, or everything was forgotten.
   */
  relive(frames: Iterable<TrackingFrame>, then: (pose: AvatarPose) => void): Promise<void>;
  /** Gives up on an estimator whose network has failed while running; call it now and then. */
  check(): void;
  /** Lets every network go that was loaded, and those that still arrive. Nothing is told from then on. */
  dispose(): Promise<void>;
}

export function createEstimatorChoice(options: EstimatorChoiceOptions): EstimatorChoice {
  let { calibration } = options;
  const loading = new Map<NetworkName, Promise<PoseRegressor>>();
  const unavailable: Partial<Record<EstimatorName, string>> = {};
  let wanted: EstimatorName = 'ik';
  let current = options.create('ik', calibration);
  let regressor: PoseRegressor | null = null;
  let disposed = false;
  /** How often what draws has changed or forgotten. */
  let changes = 0;

  const make = (name: EstimatorName, network: PoseRegressor | null): PoseEstimator =>
    network ? options.create(name, calibration, network) : options.create(name, calibration);

  function drawWith(name: EstimatorName, network: PoseRegressor | null): void {
    current = make(name, network);
    changes += 1;
    regressor = network;
    options.onChange();
  }

  function giveUp(name: EstimatorName, error: unknown): void {
    if (disposed || unavailable[name] !== undefined) return;
    unavailable[name] = reasonOf(error);
    if (wanted === name) wanted = 'ik';
    if (current.name === name) drawWith('ik', null);
    options.onFault(name, reasonOf(error));
    options.onChange();
  }

  function network(name: NetworkName): Promise<PoseRegressor> {
    const known = loading.get(name);
    if (known) return known;
    const started = options.load(name);
    loading.set(name, started);
    return started;
  }

  return {
    get current() {
      return current;
    },
    get wanted() {
      return wanted;
    },
    get regressor() {
      return regressor;
    },
    get unavailable() {
      return unavailable;
    },
    async choose(name) {
      if (disposed || unavailable[name] !== undefined) return;
      wanted = name;
      const needed = networkOf(name);
      if (needed === null) {
        drawWith(name, null);
        return;
      }
      try {
        const loaded = await network(needed);
        // While it loaded, the user may have thought of something else, or it may have failed at its first run.
        if (!disposed && wanted === name && unavailable[name] === undefined) drawWith(name, loaded);
      } catch (error) {
        if (needsRegressor(name)) giveUp(name, error);
        else if (!disposed && wanted === name) drawWith(name, null);
      }
    },
    calibrate(next) {
      calibration = next;
      changes += 1;
      current.calibrate(next);
    },
    reset() {
      changes += 1;
      current.reset();
    },
    async relive(frames, then) {
      changes += 1;
      const begun = changes;
      const living = make(current.name, regressor);
      let lived: AvatarPose | null = null;
      for (const frame of frames) {
        const { pose, request } = living.update(frame);
        // What answers within its frame is not waited for: such a method has lived through all of them at once.
        if (request) await request.ask();
        if (changes !== begun) return;
        lived = pose;
      }
      if (!lived) return;
      current = living;
      then(lived);
    },
    check() {
      const fault = current.fault();
      if (fault !== null) giveUp(current.name, fault);
    },
    async dispose() {
      disposed = true;
      changes += 1;
      current = options.create('ik', calibration);
      regressor = null;
      for (const arriving of await Promise.allSettled(loading.values())) {
        if (arriving.status === 'fulfilled') await arriving.value.dispose();
      }
    },
  };
}
