import type { AvatarPose } from '../core/body/avatar-pose';
import { type Calibration, defaultCalibration, demandPerson, sameCalibration } from '../core/body/calibration';
import { createEstimator, type NetworkName } from '../core/estimation/estimators';
import type { EstimatorName, InferenceRequest } from '../core/estimation/pose-estimator';
import type { PoseRegressor } from '../core/estimation/pose-regressor';
import { createPageClock, type PageClock } from '../core/tracking/page-clock';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { admittedFrames, type TrackedPoint, TrackingGate } from '../core/tracking/tracking-gate';
import { type AfterFrame, createAfterFrame } from './after-frame';
import { EstimatorChoice } from './estimator-choice';
import { HeightPolicy } from './height-policy';
import { type InferenceProfiler, profiled } from './inference-profiler';

export type { TrackedPoint } from '../core/tracking/tracking-gate';

/**
 * Where a body's measures come from: told by the page, the height at which a session began, a wearer who stood up taller, a stand-in who
 * moves the body instead of the wearer (or the wearer again), or nowhere yet.
 */
export type CalibrationSource = 'given' | 'headset' | 'stood-taller' | 'stand-in' | 'default';

/** What a page may want to know of a body; each is called within one of the body's methods, never its constructor, or when a network has loaded. */
export interface BodyEvents {
  /** Other measures of who moves the body, from the next frame on. */
  calibrated?(calibration: Calibration, source: CalibrationSource): void;
  /** The wearer stands this much taller [m] than the measures that were given, which stay. Once for each calibration. */
  heightmismatch?(difference: number): void;
  /** This estimator's network is not to be had, and why: inverse kinematics draws instead; with 'device' where the device reports no body. */
  fallback?(estimator: EstimatorName, reason: string): void;
  /** `estimator`, `provider` or `unavailable` is another. */
  changed?(): void;
  /** The body begins anew where it is next: nothing may be drawn, sent or scored on the way there. */
  discontinuity?(): void;
  /** No longer tracked: the body of a head that is not seen stands still; the arm of a hand that is not, or only guessed, sinks to rest. */
  trackinglost?(point: TrackedPoint): void;
  /** Tracked, for the first time or again. */
  trackingfound?(point: TrackedPoint): void;
}

export interface BodySolverOptions {
  /** Default: 'learned', which is inverse kinematics until its weights have arrived. */
  readonly estimator?: EstimatorName;
  /** 'auto' (default): from the height of the headset, and grown when its wearer stands up taller. */
  readonly calibration?: Calibration | 'auto';
  /** Whether a wearer may turn out taller than their measures (default): those of 'auto' grow then, of given ones `outgrown` tells. */
  readonly autoGrow?: boolean;
  /** Brings a network by name; rejects with a sentence. `onnxNetworks` of threepoint/onnx brings both. */
  readonly networks: (name: NetworkName) => Promise<PoseRegressor>;
  /** The time of `frame`, for pages that share one clock. Default: a clock of the body's own. */
  readonly clock?: Pick<PageClock, 'tick' | 'paused'>;
  /** Told what is done after a frame, where frame times are measured. */
  readonly profiler?: InferenceProfiler;
  readonly events?: BodyEvents;
}

/** A copy, which a page that goes on changing its own object does not change. Throws where these are no person's measures. */
function copyChecked(calibration: Calibration): Calibration {
  demandPerson(calibration);
  return { ...calibration };
}

/**
 * One wearer's body from three tracked points: estimator, fallback to inverse kinematics, a height that settles, points that are lost and found.
 * A frame is `frame`, then `update`. Told where its networks come from, it has the code of none in it; Body brings the learned one along.
 */
export class BodySolver {
  readonly #choice: EstimatorChoice;
  readonly #height: HeightPolicy;
  #events: BodyEvents;
  readonly #clock: Pick<PageClock, 'tick' | 'paused'>;
  readonly #timing: InferenceProfiler | null;
  readonly #gate = new TrackingGate({
    onChange: (point, tracked) => (tracked ? this.#events.trackingfound?.(point) : this.#events.trackinglost?.(point)),
  });
  #afterFrame: AfterFrame | null = null;
  /** In force: the wearer's, or those of a stand-in. */
  #calibration: Calibration;
  #wearer: Calibration;
  #given: boolean;
  /** Whether another than the wearer moved the body in the newest frame. */
  #standsIn = false;
  #pose: AvatarPose | null = null;
  /** The newest frame's question to a network that answers later. */
  #request: InferenceRequest | null = null;
  readonly #askNow = () => {
    const request = this.#request;
    this.#request = null;
    if (!request) return;
    this.#timing?.resume();
    void request.ask();
    this.#timing?.mark('features');
  };

  /** Throws a RangeError where the calibration is no person's, or there is no estimator of this name. */
  constructor(options: BodySolverOptions) {
    const { estimator = 'learned', calibration = 'auto', networks, profiler: timing = null } = options;
    this.#events = options.events ?? {};
    this.#clock = options.clock ?? createPageClock(() => performance.now());
    this.#timing = timing;
    this.#given = calibration !== 'auto';
    this.#wearer = calibration === 'auto' ? defaultCalibration : copyChecked(calibration);
    this.#calibration = this.#wearer;
    this.#choice = new EstimatorChoice({
      estimator,
      calibration: this.#calibration,
      create: createEstimator,
      load: timing ? async (name) => profiled(await networks(name), timing) : networks,
      onChange: () => this.#events.changed?.(),
      onFault: (name, reason) => this.#events.fallback?.(name, reason),
    });
    this.#height = new HeightPolicy({
      calibration: () => this.#wearer,
      calibrated: () => this.#given,
      autoGrow: options.autoGrow ?? true,
      onMeasured: (measured, source) => this.#measure(measured, source),
      onTooSmall: (difference) => this.#events.heightmismatch?.(difference),
    });
  }

  /** Of the newest frame, floor frame [m]; overwritten by the next: `copyAvatarPose` keeps one. null before the first. */
  get pose(): AvatarPose | null {
    return this.#pose;
  }

  /** Of who moves the body now: the wearer, or a stand-in. */
  get calibration(): Calibration {
    return this.#calibration;
  }

  /** The wearer's, also while a stand-in moves the body. */
  get wearerCalibration(): Calibration {
    return this.#wearer;
  }

  /** What draws now: inverse kinematics while a network loads, and where it fails. */
  get estimator(): EstimatorName {
    return this.#choice.current.name;
  }

  /** What was chosen, which may still be loading. */
  get wanted(): EstimatorName {
    return this.#choice.wanted;
  }

  /** What cannot be had, and why. */
  get unavailable(): Partial<Readonly<Record<EstimatorName, string>>> {
    return this.#choice.unavailable;
  }

  /** Where the network of the estimator runs: 'plain', 'wasm', 'webgpu'; null: it has none. */
  get provider(): string | null {
    return this.#choice.regressor?.provider ?? null;
  }

  /**
   * Resolves when this estimator draws, or when `fallback` told why it cannot; rejects with a RangeError where there is none of this name, else only
   * with what an event's listener throws.
   */
  setEstimator(estimator: EstimatorName): Promise<void> {
    return this.#choice.setEstimator(estimator);
  }

  /** Measures of the wearer [m], or 'auto', which forgets what was known of them. Throws a RangeError where they are no person's. */
  calibrate(calibration: Calibration | 'auto'): void {
    const given = calibration !== 'auto';
    const measures = given ? this.#own(calibration) : defaultCalibration;
    this.#given = given;
    if (!given) this.#height.startSession();
    this.#measure(measures, given ? 'given' : 'default');
  }

  /** A headset was put on: its height is taken anew. */
  startSession(): void {
    this.#height.startSession();
    this.discontinuity();
  }

  /** The floor lies elsewhere from one frame to the next (recentre, teleport, pause): nothing may be drawn on the way. */
  discontinuity(): void {
    // A question that still waits is about a frame from before.
    this.#request = null;
    this.#choice.reset();
    this.#height.reset();
    this.#events.discontinuity?.();
  }

  /**
   * Begins an animation frame that the browser dates `timestampMs`: its time [s], which never goes back and leaps half a second at most, for
   * the frame of tracking that follows. After a pause the body has jumped.
   */
  tick(timestampMs: number): number {
    const time = this.#clock.tick(timestampMs);
    if (this.#clock.paused) this.discontinuity();
    return time;
  }

  /**
   * One frame of tracking [m, s], floor frame; null: the head is not seen, and the pose stays. A point with a number that is not finite counts as
   * not seen, a time that is none as no time since the frame before. `standIn`: the measures of another who moves the body in this frame, as an
   * actor or a recording does; theirs are in force then, and nothing is learnt of the wearer. Returns the body's pose, null before the first
   * frame. Never waits, never returns NaN; throws a RangeError where a stand-in's measures are no person's, else only what an event's listener
   * throws.
   */
  update(tracked: TrackingFrame | null, standIn: Calibration | null = null): AvatarPose | null {
    const frame = this.#gate.admit(tracked);
    if (frame === null) {
      this.#height.lose();
      return this.#pose;
    }
    if (!this.#isMovedBy(standIn)) this.#handOver(standIn && this.#own(standIn));
    if (standIn === null) this.#height.observe(frame);
    const { pose, request } = this.#choice.current.update(frame);
    this.#pose = pose;
    if (request) this.#askLater(request);
    this.#choice.check();
    return pose;
  }

  /**
   * Draws a moment as if the body had come there moving: these frames of tracking lead up to it, floor frame, times rising. Each answer of a
   * network is waited for; with one that answers at once `pose` is the moment's when this returns, else when it resolves. Nothing comes of it
   * where the body jumps meanwhile, or another method is chosen.
   */
  warmUp(frames: Iterable<TrackingFrame>): Promise<void> {
    return this.#choice.warmUp(admittedFrames(frames), (pose) => {
      this.#pose = pose;
    });
  }

  /** Nothing is told from now on; resolves when every network is let go that was loaded for this body. */
  dispose(): Promise<void> {
    this.#events = {};
    this.#request = null;
    this.#afterFrame?.close();
    return this.#choice.dispose();
  }

  /** Forgets which points were seen, without a word: another session begins. */
  endSession(): void {
    this.#gate.reset();
  }

  /** Measures that a page gives, apart from its own object, unless it had them of this body. */
  #own(calibration: Calibration): Calibration {
    const known = calibration === this.#calibration || calibration === this.#wearer;
    return known ? calibration : copyChecked(calibration);
  }

  /** Whether they moved it in the frame before; a page may write the measures of a stand-in out in every frame. */
  #isMovedBy(standIn: Calibration | null): boolean {
    if (standIn === null) return !this.#standsIn;
    return this.#standsIn && sameCalibration(standIn, this.#calibration);
  }

  /** Another moves the body from this frame on: with their measures, and without a way from the one to the other. */
  #handOver(standIn: Calibration | null): void {
    this.#standsIn = standIn !== null;
    this.discontinuity();
    this.#fit(standIn ?? this.#wearer, 'stand-in');
  }

  /** Other measures of the wearer; they wait while one with measures of their own stands in. */
  #measure(calibration: Calibration, source: CalibrationSource): void {
    const inForce = this.#calibration === this.#wearer;
    this.#wearer = calibration;
    if (inForce) this.#fit(calibration, source);
  }

  #fit(calibration: Calibration, source: CalibrationSource): void {
    if (calibration === this.#calibration) return;
    this.#calibration = calibration;
    this.#choice.calibrate(calibration);
    this.#events.calibrated?.(calibration, source);
  }

  /** Asks a network that answers later once the picture is on its way; a newer frame's question takes the place of one that still waits. */
  #askLater(request: InferenceRequest): void {
    const waits = this.#request !== null;
    this.#request = request;
    if (waits) return;
    this.#afterFrame ??= createAfterFrame();
    this.#afterFrame.afterwards(this.#askNow);
  }
}
