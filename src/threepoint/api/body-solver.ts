import type { AvatarPose } from '../core/body/avatar-pose';
import { assertCalibration, type Calibration, defaultCalibration, sameCalibration } from '../core/body/calibration';
import { createEstimator, type NetworkName } from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import type { Pinning } from '../core/estimation/pinning';
import type { EstimatorName, InferenceRequest } from '../core/estimation/pose-estimator';
import type { TrackerMismatch } from '../core/estimation/tracker-watch';
import { createPageClock, type PageClock } from '../core/tracking/page-clock';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { type TrackedPoint, TrackedPoints, TrackingGate, validFrames } from '../core/tracking/tracking-gate';
import { assertOptions, optionNames } from './assert-options';
import { EstimatorSelector } from './estimator-selector';
import { HeightEstimator } from './height-estimator';
import { type InferenceProfiler, withProfiler } from './inference-profiler';
import { warnAfterDispose } from './warnings';

/**
 * The origin of a body's measures: given by the page, the headset's height at the start of a session, a user who
 * stood up taller, a change between the user and a stand-in, or the default.
 */
export type CalibrationSource = 'given' | 'headset' | 'stood-taller' | 'stand-in' | 'default';

/**
 * The events of a body with their data. Each is reported from within one of the body's methods, or when a network has
 * loaded; never from the constructor.
 */
export interface BodyEvents {
  /** The measures in force have changed, from the next frame on. */
  readonly calibrated: { readonly calibration: Calibration; readonly source: CalibrationSource };
  /**
   * The user stands `difference` [m] taller than the given measures, which stay in force. Reported once for each
   * calibration.
   */
  readonly heightmismatch: { readonly difference: number };
  /**
   * The estimator's network failed or could not be loaded, or 'device' is selected and the device reports no body:
   * inverse kinematics draws instead.
   */
  readonly fallback: { readonly estimator: EstimatorName; readonly reason: string };
  /** `estimator`, `provider` or `unavailableEstimators` has changed. */
  readonly estimatorchange: object;
  /** The body was reset and continues elsewhere. Do not interpolate between its last pose and the next. */
  readonly discontinuity: object;
  /**
   * The point is no longer tracked. Without a head the body keeps its pose; the arm of a lost or guessed hand sinks to
   * rest.
   */
  readonly trackinglost: { readonly point: TrackedPoint };
  /** The point is tracked, for the first time or again. */
  readonly trackingfound: { readonly point: TrackedPoint };
  /**
   * The joint of a tracker beyond head and hands has been out of the body's reach for a second. The tracker is worn
   * elsewhere, or the measures are another person's. Reported once until the body reaches it.
   */
  readonly trackermismatch: TrackerMismatch;
  /** A session starts: frames of its user follow. */
  readonly sessionstart: object;
  /** The session is over: `pose` is null. Stop showing the last pose to others. */
  readonly sessionend: object;
}

/** Callbacks of a body's events. */
export type BodyCallbacks = { readonly [Name in keyof BodyEvents]?: (event: BodyEvents[Name]) => void };

export interface BodySolverOptions {
  /** The estimator. Default: 'learned', replaced by inverse kinematics until its weights have loaded. */
  readonly estimator?: EstimatorName;
  /**
   * The user's measures. 'auto' (default): estimated from the headset's height, and enlarged when the user stands
   * taller.
   */
  readonly calibration?: Calibration | 'auto';
  /**
   * Whether the user may stand taller than the measures (default: true). Those of 'auto' grow; given ones stay, and
   * `heightmismatch` is called.
   */
  readonly autoGrow?: boolean;
  /**
   * Loads a network by name; rejects with an Error whose message is a sentence. `onnxNetworks` of threepoint/onnx loads
   * both.
   */
  readonly networks: (name: NetworkName) => Promise<PoseRegressor>;
  /** Draws the trackers of frames: `pinning` of threepoint/trackers. Without it frames must have none. */
  readonly pinning?: Pinning;
  /** The clock of `tick`, for pages that share one. Default: a clock of the body. */
  readonly clock?: Pick<PageClock, 'tick' | 'paused'>;
  /** Measures the work that follows a frame. */
  readonly profiler?: InferenceProfiler;
  readonly events?: BodyCallbacks;
}

export const bodyOptions = optionNames<BodySolverOptions>({
  estimator: true,
  calibration: true,
  autoGrow: true,
  networks: true,
  pinning: true,
  clock: true,
  profiler: true,
  events: true,
});

export const eventNames = optionNames<BodyEvents>({
  calibrated: true,
  heightmismatch: true,
  fallback: true,
  estimatorchange: true,
  discontinuity: true,
  trackinglost: true,
  trackingfound: true,
  trackermismatch: true,
  sessionstart: true,
  sessionend: true,
});

/**
 * Solves the body of one user from three tracked points. It selects the estimator, falls back to inverse kinematics,
 * estimates the user's height and reports lost points. Each frame is one call of `tick` and one of `update`. It
 * contains no network: `networks` loads them. `Body` adds the learned network.
 *
 * @example
 * const body = new BodySolver({ networks: onnxNetworks({ modelUrl: (name) => `/models/${name}.json` }) });
 * const time = body.tick(timestampMs);
 * const pose = body.update({ time, head, leftHand, rightHand: null });
 */
export class BodySolver {
  readonly #choice: EstimatorSelector;
  readonly #height: HeightEstimator;
  #events: BodyCallbacks;
  readonly #clock: Pick<PageClock, 'tick' | 'paused'>;
  readonly #profiler: InferenceProfiler | null;
  readonly #pinning: Pinning | undefined;
  readonly #gate = new TrackingGate();
  readonly #points = new TrackedPoints((point, tracked) =>
    this.#events[tracked ? 'trackingfound' : 'trackinglost']?.({ point }),
  );
  /** Runs `#sendRequest` after a frame: a message is the earliest task that a page can schedule. */
  #afterFrame: MessageChannel | null = null;
  #calibration: Calibration;
  #userCalibration: Calibration;
  #given: boolean;
  /** Whether a stand-in moved the body in the newest frame. */
  #hasStandIn = false;
  #pose: AvatarPose | null = null;
  #inSession = false;
  #disposed = false;
  /** The newest frame's request to a network that runs after the frame. */
  #request: InferenceRequest | null = null;
  readonly #sendRequest = () => {
    const request = this.#request;
    this.#request = null;
    if (!request) return;
    this.#profiler?.resume();
    void request.ask();
    this.#profiler?.mark('features');
  };

  /**
   * Throws a RangeError for a calibration that no person has or an unknown estimator, a TypeError for an unknown
   * option.
   */
  constructor(options: BodySolverOptions) {
    assertOptions('Body', options, bodyOptions);
    assertOptions('the events of Body', options.events ?? {}, eventNames);
    const { estimator = 'learned', calibration = 'auto', networks, profiler = null } = options;
    const pinning = options.pinning?.reportingTo((mismatch) => this.#events.trackermismatch?.(mismatch));
    this.#events = options.events ?? {};
    this.#clock = options.clock ?? createPageClock(() => performance.now());
    this.#profiler = profiler;
    this.#pinning = pinning;
    this.#given = calibration !== 'auto';
    this.#userCalibration = calibration === 'auto' ? defaultCalibration : this.#copyChecked(calibration);
    this.#calibration = this.#userCalibration;
    this.#choice = new EstimatorSelector({
      estimator,
      calibration: this.#calibration,
      create: (name, body, regressor) => createEstimator(name, body, regressor, { pinning }),
      load: profiler ? async (name) => withProfiler(await networks(name), profiler) : networks,
      onChange: () => this.#events.estimatorchange?.({}),
      onUnavailable: (name, reason) => this.#events.fallback?.({ estimator: name, reason }),
    });
    this.#height = new HeightEstimator(options.autoGrow ?? true);
  }

  /**
   * The pose of the newest frame, floor frame [m]; null before the first, after a session and after `dispose`. The next
   * frame overwrites it: keep it with `copyAvatarPose`.
   */
  get pose(): AvatarPose | null {
    return this.#pose;
  }

  /** The measures in force: the user's, or a stand-in's. */
  get calibration(): Calibration {
    return this.#calibration;
  }

  /** The user's measures, also while a stand-in moves the body. */
  get userCalibration(): Calibration {
    return this.#userCalibration;
  }

  /** The estimator in use: 'ik' while a network loads, and after it failed. */
  get estimator(): EstimatorName {
    return this.#choice.current.name;
  }

  /** The selected estimator, which may still be loading. */
  get selectedEstimator(): EstimatorName {
    return this.#choice.selected;
  }

  /** The estimators that are unavailable, each with the reason. */
  get unavailableEstimators(): Partial<Readonly<Record<EstimatorName, string>>> {
    return this.#choice.unavailable;
  }

  /** The backend of the estimator's network: 'plain', 'wasm' or 'webgpu'; null: it has no network. */
  get provider(): string | null {
    return this.#choice.regressor?.provider ?? null;
  }

  /**
   * Selects the estimator. Resolves when it is in use, or after `fallback` was called because it is unavailable.
   * Rejects with a RangeError where no estimator has this name, or with what a callback throws.
   */
  setEstimator(estimator: EstimatorName): Promise<void> {
    return this.#choice.setEstimator(estimator);
  }

  /**
   * Sets the user's measures [m]; 'auto' discards them and estimates new ones. Throws a RangeError where they are not
   * human.
   */
  calibrate(calibration: Calibration | 'auto'): void {
    const given = calibration !== 'auto';
    const measures = given ? this.#own(calibration) : defaultCalibration;
    this.#given = given;
    if (!given) this.#height.startSession();
    this.#setUserCalibration(measures, given ? 'given' : 'default');
  }

  /** Starts a session: a headset was put on, and the user's height is estimated again. */
  startSession(): void {
    this.#inSession = true;
    this.#height.startSession();
    this.discontinuity();
    this.#events.sessionstart?.({});
  }

  /**
   * Ends the session: `pose` is null, and every point counts as not tracked, without a call of `trackinglost`. Calls
   * `sessionend` if a session was started.
   */
  endSession(): void {
    const ends = this.#inSession;
    this.#inSession = false;
    this.#request = null;
    this.#pose = null;
    this.#points.reset();
    this.#choice.reset();
    if (ends) this.#events.sessionend?.({});
  }

  /** Resets the body because the floor lies elsewhere from the next frame on (recentre, teleport, pause). */
  discontinuity(): void {
    // A pending request belongs to a frame of the past.
    this.#request = null;
    this.#choice.reset();
    this.#height.reset();
    this.#events.discontinuity?.({});
  }

  /**
   * Starts an animation frame with the browser's time stamp `timestampMs`. Returns the time [s] of its tracking frame,
   * which never goes back and advances by half a second at most. A pause is a discontinuity.
   */
  tick(timestampMs: number): number {
    const time = this.#clock.tick(timestampMs);
    if (this.#clock.paused) this.discontinuity();
    return time;
  }

  /**
   * Solves one tracking frame, floor frame [m, s]. Returns the body's pose; null before the first frame of a session.
   * Without a head (null) the pose stays as it is: `trackinglost` reports it. A point with a number that is not finite
   * counts as lost; an invalid time counts as that of the frame before. `standIn`: the measures of another person who
   * moves the body in this frame, such as an actor or a recording; they are in force in this frame, and nothing is
   * estimated about the user. Never waits and never returns NaN. After `dispose` it returns null and warns once. Throws
   * a RangeError where a stand-in's measures are not human, a TypeError where the frame has trackers and the body no
   * `pinning`, or what a callback throws.
   */
  update(tracked: TrackingFrame | null, standIn: Calibration | null = null): AvatarPose | null {
    return this.solve(this.#gate.validate(tracked), standIn);
  }

  /**
   * Solves a frame as `update` does, without checking it: one that `TrackedSession`, `BodyTracker` or `parseRecording`
   * has returned, or that was made from it.
   */
  solve(frame: TrackingFrame | null, standIn: Calibration | null = null): AvatarPose | null {
    if (this.#disposed) {
      warnAfterDispose(this, 'Body');
      return null;
    }
    this.#points.follow(frame);
    if (frame === null) {
      this.#height.onHeadLost();
      return this.#pose;
    }
    if (!this.#isDrivenBy(standIn)) this.#changeDriver(standIn && this.#own(standIn));
    if (standIn === null) this.#observeHeight(frame);
    const { pose, request } = this.#choice.current.update(frame);
    this.#pose = pose;
    if (request) this.#scheduleRequest(request);
    this.#choice.check();
    return pose;
  }

  /**
   * Runs the estimator over these frames (floor frame, rising times) and sets `pose` to the result of the last. Awaits
   * each result of the network. With a network that runs within the frame, `pose` is set when this returns, else when
   * it resolves. Has no effect if the body is reset or another estimator is selected before it resolves.
   */
  warmUp(frames: Iterable<TrackingFrame>): Promise<void> {
    return this.#choice.warmUp(validFrames(frames), (pose) => {
      this.#pose = pose;
    });
  }

  /**
   * Removes all callbacks; later frames have no effect. Resolves when every network that was loaded for this body is
   * released.
   */
  dispose(): Promise<void> {
    this.#disposed = true;
    this.#events = {};
    this.#request = null;
    this.#pose = null;
    // An open port keeps a Node process running.
    this.#afterFrame?.port1.close();
    return this.#choice.dispose();
  }

  /** Returns a copy of a page's measures, or the measures themselves if this body returned them before. */
  #own(calibration: Calibration): Calibration {
    const known = calibration === this.#calibration || calibration === this.#userCalibration;
    return known ? calibration : this.#copyChecked(calibration);
  }

  /** Returns a copy that the page cannot change. Throws a RangeError where the measures are not human. */
  #copyChecked(calibration: Calibration): Calibration {
    assertCalibration(calibration);
    this.#pinning?.assertOffsets(calibration);
    return { ...calibration };
  }

  #observeHeight(frame: TrackingFrame): void {
    const change = this.#height.observe(frame, this.#userCalibration, this.#given);
    if (!change) return;
    if ('difference' in change) this.#events.heightmismatch?.(change);
    else this.#setUserCalibration(change.calibration, change.source);
  }

  /**
   * Returns whether the same person moved the body in the previous frame; equal measures in another object are the same
   * person.
   */
  #isDrivenBy(standIn: Calibration | null): boolean {
    if (standIn === null) return !this.#hasStandIn;
    return this.#hasStandIn && sameCalibration(standIn, this.#calibration);
  }

  /** Sets the person that moves the body from this frame on: a stand-in, or the user (null). */
  #changeDriver(standIn: Calibration | null): void {
    this.#hasStandIn = standIn !== null;
    this.discontinuity();
    this.#applyCalibration(standIn ?? this.#userCalibration, 'stand-in');
  }

  /** Sets the user's measures; they come into force when no stand-in moves the body. */
  #setUserCalibration(calibration: Calibration, source: CalibrationSource): void {
    const inForce = this.#calibration === this.#userCalibration;
    this.#userCalibration = calibration;
    if (inForce) this.#applyCalibration(calibration, source);
  }

  #applyCalibration(calibration: Calibration, source: CalibrationSource): void {
    if (calibration === this.#calibration) return;
    this.#calibration = calibration;
    this.#choice.calibrate(calibration);
    this.#events.calibrated?.({ calibration, source });
  }

  /** Sends the request to the network after the frame; a newer request replaces a pending one. */
  #scheduleRequest(request: InferenceRequest): void {
    const waits = this.#request !== null;
    this.#request = request;
    if (waits) return;
    if (!this.#afterFrame) {
      this.#afterFrame = new MessageChannel();
      this.#afterFrame.port1.onmessage = this.#sendRequest;
    }
    this.#afterFrame.port2.postMessage(null);
  }
}
