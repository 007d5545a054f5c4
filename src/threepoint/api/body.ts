import type { AvatarPose } from '../core/body/avatar-pose';
import {
  assertCalibration,
  type Calibration,
  defaultCalibration,
  type GripOffsets,
  sameCalibration,
} from '../core/body/calibration';
import { createEstimator, type NetworkName } from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import type { Pinning } from '../core/estimation/pinning';
import type { DefaultMethod, EstimatorName, InferenceRequest, PaperMethod } from '../core/estimation/pose-estimator';
import { createPageClock, type PageClock } from '../core/tracking/page-clock';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { TrackedPoints, TrackingGate, validFrames } from '../core/tracking/tracking-gate';
import { assertOptions, optionNames } from './assert-options';
import type { BodyEvents, CalibrationSource } from './body-events';
import { EstimatorSelector } from './estimator-selector';
import { emit, TypedEvents } from './event-target';
import { HeightEstimator } from './height-estimator';
import { type InferenceProfiler, withProfiler } from './inference-profiler';
import { loadWithoutRuntime } from './load-learned';
import { warnAfterDispose, warnOfFallback } from './warnings';

/** Loads a network by name; rejects with an Error whose message is a sentence. */
export interface LoadNetwork<Method extends PaperMethod = never> {
  (name: NetworkName): Promise<PoseRegressor>;
  /** The methods that its networks bring; absent: those of every body. */
  readonly methods?: readonly Method[];
}

export interface BodyOptions<Method extends PaperMethod = never> {
  /**
   * The estimator. Default: 'learned', replaced by inverse kinematics until its weights have loaded. 'paper' and
   * 'paper-published' need `networks`.
   */
  readonly estimator?: DefaultMethod | NoInfer<Method>;
  /**
   * The user's measures. 'auto' (default): estimated from the headset's height, and enlarged when the user stands
   * taller.
   */
  readonly calibration?: Calibration | 'auto';
  /**
   * Whether the user may stand taller than the measures (default: true). Those of 'auto' grow; given ones stay, and
   * `heightmismatch` is dispatched.
   */
  readonly autoGrow?: boolean;
  /**
   * Loads the networks. Default: the learned network without a runtime. `onnxNetworks` of threepoint/onnx loads both
   * networks, and brings the methods of the paper.
   */
  readonly networks?: LoadNetwork<Method>;
  /** Draws the trackers of frames: `pinning` of threepoint/trackers. Without it frames must have none. */
  readonly pinning?: Pinning;
  /**
   * The clock of `tick`, for pages that share one. Default: a clock of the body.
   *
   * @internal
   */
  readonly clock?: Pick<PageClock, 'tick' | 'paused'>;
  /**
   * Measures the work that follows a frame.
   *
   * @internal
   */
  readonly profiler?: InferenceProfiler;
}

export const bodyOptions = optionNames<Omit<BodyOptions, 'clock' | 'profiler'>>({
  estimator: true,
  calibration: true,
  autoGrow: true,
  networks: true,
  pinning: true,
});
/** Options of this repository's page, which declarations and messages do not name. */
export const internalOptions = ['clock', 'profiler'];

/**
 * Solves the body of one user from three tracked points, without a renderer. It selects the estimator, falls back to
 * inverse kinematics, estimates the user's height and dispatches `BodyEvents`. BodyTracker of threepoint/three adds a
 * session and an avatar.
 *
 * @example
 * const body = new Body({ calibration: { eyeHeight: 1.6, armSpan: 1.51 } });
 * body.addEventListener('trackinglost', ({ point }) => console.log(point));
 * const pose = body.update({ time, head, leftHand, rightHand: null });
 */
export class Body<Method extends PaperMethod = never> extends TypedEvents<BodyEvents> {
  readonly #choice: EstimatorSelector;
  readonly #height: HeightEstimator;
  readonly #clock: Pick<PageClock, 'tick' | 'paused'>;
  readonly #profiler: InferenceProfiler | null;
  readonly #pinning: Pinning | undefined;
  readonly #gate = new TrackingGate();
  readonly #points = new TrackedPoints((point, tracked) =>
    this.#emit(tracked ? 'trackingfound' : 'trackinglost', { point }),
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
  constructor(options: BodyOptions<Method> = {}) {
    super();
    assertOptions('Body', options, bodyOptions, internalOptions);
    const { estimator = 'learned', calibration = 'auto', networks = loadWithoutRuntime, profiler = null } = options;
    const pinning = options.pinning?.reportingTo((mismatch) => this.#emit('trackermismatch', mismatch));
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
      onChange: () => this.#emit('estimatorchange', {}),
      onUnavailable: (name, reason) => this.#reportFallback(name, reason),
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
  get estimator(): DefaultMethod | Method {
    // reason: no other can be selected.
    return this.#choice.current.name as DefaultMethod | Method;
  }

  /** The selected estimator, which may still be loading. */
  get selectedEstimator(): DefaultMethod | Method {
    return this.#choice.selected as DefaultMethod | Method;
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
   * Selects the estimator. Resolves when it is in use, or after the event `fallback` because it is unavailable. Rejects
   * with a RangeError where no estimator has this name.
   */
  setEstimator(estimator: DefaultMethod | Method): Promise<void> {
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

  /** Sets the user's corrections of how they hold controllers. Throws a RangeError where one is too large. */
  setGripOffsets(gripOffsets: GripOffsets): void {
    const calibration = this.#copyChecked({ ...this.#userCalibration, gripOffsets });
    if (this.#calibration === this.#userCalibration) this.#calibration = calibration;
    this.#userCalibration = calibration;
  }

  /** Starts a session: a headset was put on, and the user's height is estimated again. */
  startSession(): void {
    this.#inSession = true;
    this.#height.startSession();
    this.discontinuity();
    this.#emit('sessionstart', {});
  }

  /**
   * Ends the session: `pose` is null, and every point counts as not tracked, without the event `trackinglost`.
   * Dispatches `sessionend` if a session was started.
   */
  endSession(): void {
    const ends = this.#inSession;
    this.#inSession = false;
    this.#request = null;
    this.#pose = null;
    this.#points.reset();
    this.#choice.reset();
    if (ends) this.#emit('sessionend', {});
  }

  /** Resets the body because the floor lies elsewhere from the next frame on (recentre, teleport, pause). */
  discontinuity(): void {
    // A pending request belongs to a frame of the past.
    this.#request = null;
    this.#choice.reset();
    this.#height.reset();
    this.#emit('discontinuity', {});
  }

  /**
   * Starts an animation frame with the browser's time stamp `timestampMs`. Returns the time [s] of its tracking frame,
   * which never goes back and advances by half a second at most. A pause is a discontinuity.
   *
   * @internal
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
   * `pinning`.
   */
  update(tracked: TrackingFrame | null, standIn: Calibration | null = null): AvatarPose | null {
    return this.solve(this.#gate.validate(tracked), standIn);
  }

  /**
   * Solves a frame as `update` does, without checking it: one that `TrackedSession`, `BodyTracker` or `parseRecording`
   * has returned, or that was made from it.
   *
   * @internal
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
   *
   * @internal
   */
  warmUp(frames: Iterable<TrackingFrame>): Promise<void> {
    return this.#choice.warmUp(validFrames(frames), (pose) => {
      this.#pose = pose;
    });
  }

  /**
   * Ends all events; later frames have no effect. Resolves when every network that was loaded for this body is
   * released.
   */
  dispose(): Promise<void> {
    this.#disposed = true;
    this.#request = null;
    this.#pose = null;
    // An open port keeps a Node process running.
    this.#afterFrame?.port1.close();
    return this.#choice.dispose();
  }

  #emit<Name extends keyof BodyEvents>(type: Name, event: BodyEvents[Name]): boolean {
    return !this.#disposed && emit(this, type, event);
  }

  /** Warns that inverse kinematics draws, unless a listener prevents that. */
  #reportFallback(estimator: EstimatorName, reason: string): void {
    const event = { estimator, reason };
    if (!this.#disposed && !this.#emit('fallback', event)) warnOfFallback(event);
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
    if ('difference' in change) this.#emit('heightmismatch', change);
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
  #setUserCalibration(measures: Calibration, source: CalibrationSource): void {
    const { gripOffsets } = this.#userCalibration;
    const calibration = measures.gripOffsets || !gripOffsets ? measures : { ...measures, gripOffsets };
    const inForce = this.#calibration === this.#userCalibration;
    this.#userCalibration = calibration;
    if (inForce) this.#applyCalibration(calibration, source);
  }

  #applyCalibration(calibration: Calibration, source: CalibrationSource): void {
    if (calibration === this.#calibration) return;
    this.#calibration = calibration;
    this.#choice.calibrate(calibration);
    this.#emit('calibrated', { calibration, source });
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
