import type { AvatarPose } from '../core/body/avatar-pose';
import { type Calibration, calibrationComplaint, defaultCalibration } from '../core/body/calibration';
import { createEstimator, type NetworkName } from '../core/estimation/estimators';
import type { EstimatorName, InferenceRequest } from '../core/estimation/pose-estimator';
import type { PoseRegressor } from '../core/estimation/pose-regressor';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { createAfterFrame } from './after-frame';
import { createEstimatorChoice, type EstimatorChoice } from './estimator-choice';
import { HeightPolicy } from './height-policy';
import { loadLearned } from './load-learned';

/** A point that a headset tracks. */
export type TrackedPoint = 'head' | 'left' | 'right';
const trackedPoints = ['head', 'left', 'right'] as const;

/** Where a body's measures come from: told by the page, the height at which a session began, or a wearer who stood up taller. */
export type CalibrationSource = 'given' | 'headset' | 'stood-taller';

/** What a page may want to know of a body; each is called within `update`, `calibrate` or when a network has loaded. */
export interface BodyEvents {
  /** Other measures from the next frame on. */
  calibrated?(calibration: Calibration, source: CalibrationSource): void;
  /** This estimator is not to be had, and why: inverse kinematics draws instead. */
  fallback?(estimator: EstimatorName, reason: string): void;
  /** No longer tracked: the head's body stands still, a hand's arm sinks to rest. */
  lost?(point: TrackedPoint): void;
  /** Tracked, for the first time or again. */
  found?(point: TrackedPoint): void;
}

export interface BodyOptions {
  /** Default: 'learned', which is inverse kinematics until its weights have arrived. */
  readonly estimator?: EstimatorName;
  /** 'auto' (default): from the height of the headset, and grown when its wearer stands up taller. */
  readonly calibration?: Calibration | 'auto';
  /** Brings a network by name. Default: the learned one without a runtime; `onnxNetworks` of threepoint/onnx brings both. */
  readonly networks?: (name: NetworkName) => Promise<PoseRegressor>;
  readonly events?: BodyEvents;
}

/** Throws where these are no person's measures. */
function checked(calibration: Calibration): Calibration {
  const complaint = calibrationComplaint(calibration);
  if (complaint) throw new RangeError(complaint);
  return calibration;
}

/**
 * One wearer's body from three tracked points: estimator, fallback to inverse kinematics, a height that settles, points that are lost and found.
 * Knows no renderer; BodyTracker of threepoint/three is this with a session and an avatar.
 */
export class Body {
  readonly #choice: EstimatorChoice;
  readonly #height: HeightPolicy;
  readonly #events: BodyEvents;
  readonly #seen: Record<TrackedPoint, boolean> = { head: false, left: false, right: false };
  #afterFrame: ((task: () => void) => void) | null = null;
  #calibration: Calibration;
  #given: boolean;
  #pose: AvatarPose | null = null;
  /** The newest frame's question to a network that answers later. */
  #request: InferenceRequest | null = null;
  #disposed = false;
  readonly #askNow = () => {
    const request = this.#request;
    this.#request = null;
    void request?.ask();
  };

  constructor(options: BodyOptions = {}) {
    const { estimator = 'learned', calibration = 'auto', networks = defaultNetworks, events = {} } = options;
    this.#events = events;
    this.#given = calibration !== 'auto';
    this.#calibration = calibration === 'auto' ? defaultCalibration : checked(calibration);
    this.#choice = createEstimatorChoice({
      calibration: this.#calibration,
      create: createEstimator,
      load: networks,
      onChange: () => undefined,
      onFault: (name, reason) => {
        if (!this.#disposed) this.#events.fallback?.(name, reason);
      },
    });
    this.#height = new HeightPolicy({
      calibration: () => this.#calibration,
      calibrated: () => this.#given,
      mayGuess: () => true,
      mayGrow: () => !this.#given,
      onMeasured: (measured, source) => this.#take(measured, source),
      onTooSmall: () => undefined,
    });
    void this.#choice.choose(estimator);
  }

  /** Of the newest frame, floor frame [m]; overwritten by the next: `copyAvatarPose` keeps one. null before the first. */
  get pose(): AvatarPose | null {
    return this.#pose;
  }

  get calibration(): Calibration {
    return this.#calibration;
  }

  /** What draws now: inverse kinematics while a network loads, and where it fails. */
  get estimator(): EstimatorName {
    return this.#choice.current.name;
  }

  /** Resolves when this estimator draws, or when `fallback` told why it cannot. */
  choose(estimator: EstimatorName): Promise<void> {
    return this.#choice.choose(estimator);
  }

  /** Measures of the wearer [m], or 'auto'. Throws a RangeError where they are no person's. */
  calibrate(calibration: Calibration | 'auto'): void {
    this.#given = calibration !== 'auto';
    if (calibration === 'auto') this.#height.begin();
    else this.#take(checked(calibration), 'given');
  }

  /** A headset was put on: its height is taken anew. */
  begin(): void {
    this.#height.begin();
    this.jumped();
  }

  /** The floor lies elsewhere from one frame to the next (recentre, teleport, pause): nothing may be drawn on the way. */
  jumped(): void {
    this.#choice.reset();
    this.#height.reset();
  }

  /**
   * One frame of tracking [m, s], floor frame; null: the head is not seen, and the pose stays. Returns the body's pose, null before the
   * first frame. Never throws, never waits, never returns NaN.
   */
  update(frame: TrackingFrame | null): AvatarPose | null {
    this.#notice('head', frame !== null);
    this.#notice('left', frame?.leftHand != null);
    this.#notice('right', frame?.rightHand != null);
    if (frame === null) return this.#pose;
    this.#height.observe(frame);
    const { pose, request } = this.#choice.current.update(frame);
    this.#pose = pose;
    if (request) this.#askLater(request);
    this.#choice.check();
    return pose;
  }

  /** Nothing is told from now on; a network that was loaded is let go. */
  dispose(): void {
    this.#disposed = true;
    this.#request = null;
    void this.#choice.regressor?.dispose();
  }

  /** Forgets which points were seen, without a word: another session begins. */
  forgetPoints(): void {
    for (const point of trackedPoints) this.#seen[point] = false;
  }

  #take(calibration: Calibration, source: CalibrationSource): void {
    this.#calibration = calibration;
    this.#choice.calibrate(calibration);
    this.#events.calibrated?.(calibration, source);
  }

  #notice(point: TrackedPoint, seen: boolean): void {
    if (this.#seen[point] === seen) return;
    this.#seen[point] = seen;
    if (seen) this.#events.found?.(point);
    else this.#events.lost?.(point);
  }

  /** Asks a network that answers later once the picture is on its way; a newer frame's question takes the place of one that still waits. */
  #askLater(request: InferenceRequest): void {
    const waits = this.#request !== null;
    this.#request = request;
    if (waits) return;
    this.#afterFrame ??= createAfterFrame();
    this.#afterFrame(this.#askNow);
  }
}

function defaultNetworks(name: NetworkName): Promise<PoseRegressor> {
  if (name === 'learned') return loadLearned();
  return Promise.reject(new Error('the paper’s network needs a runtime: networks: onnxNetworks() of threepoint/onnx'));
}
