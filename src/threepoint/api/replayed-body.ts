import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import { type Replayable, sampleRecording } from '../core/tracking/recording';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import type { BodySolver } from './body-solver';

/** A replay that may move a body. */
export interface ReplayState {
  readonly mode: 'idle' | 'recording' | 'replaying';
  /** Whether the replay is paused. */
  readonly paused: boolean;
  /** The position in the recording [s]. */
  readonly seconds: number;
  /** The recording; null: none is loaded. */
  readonly recording: Replayable | null;
}

/** The time [s] before a moment for which a body is warmed up. */
const warmUpSeconds = 5;
/** The highest frame rate of the warm-up [Hz], whichever one a recording has. */
const maxWarmUpHz = 60;

/** Yields the frames of a recording up to a second of it, which gets the time `time` [s]. */
export function* warmUpFrames(recording: Replayable, seconds: number, time: number): Generator<TrackingFrame> {
  const first = recording.frames.at(0)!.time;
  const rateHz = Math.min(recording.rateHz, maxWarmUpHz);
  for (let left = Math.floor(Math.min(warmUpSeconds, seconds) * rateHz); left >= 0; left--) {
    const before = left / rateHz;
    yield { ...sampleRecording(recording, first + seconds - before), time: time - before };
  }
}

/**
 * Drives a body by a replay. While the replay is paused, the body's time stands still and its state does not fade.
 * After a seek in a paused replay, or a change of the estimator, the body is warmed up with the seconds before.
 */
export class ReplayedBody {
  readonly #body: Pick<BodySolver, 'update' | 'warmUp' | 'discontinuity' | 'pose' | 'estimator'>;
  readonly #replay: ReplayState;
  /** The time for which replays were paused since the last one began [s]. */
  #pausedSeconds = 0;
  /** The time of the newest frame, by the page's clock [s]. */
  #time = Number.NaN;
  /** The moment and the method that are drawn. */
  readonly #drawn: { recording: Replayable | null; seconds: number; method: string } = {
    recording: null,
    seconds: 0,
    method: '',
  };

  constructor(
    body: Pick<BodySolver, 'update' | 'warmUp' | 'discontinuity' | 'pose' | 'estimator'>,
    replay: ReplayState,
  ) {
    this.#body = body;
    this.#replay = replay;
  }

  /** Solves one tracking frame; see `update` of the body. */
  update(frame: TrackingFrame | null, standIn: Calibration | null): AvatarPose | null {
    const { mode, paused } = this.#replay;
    if (!frame || mode !== 'replaying') {
      this.stop();
      return this.#body.update(frame, standIn);
    }
    if (paused) return this.#updatePaused(frame, standIn);
    this.#time = frame.time;
    if (this.#hasRestarted()) this.#body.discontinuity();
    const pose = this.#body.update(this.#withBodyTime(frame), standIn);
    this.#updateDrawn();
    return pose;
  }

  /** Forgets the replay that moved the body. */
  stop(): void {
    this.#pausedSeconds = 0;
    this.#drawn.recording = null;
  }

  #updatePaused(frame: TrackingFrame, standIn: Calibration | null): AvatarPose | null {
    if (this.#drawn.recording) this.#pausedSeconds += frame.time - this.#time;
    this.#time = frame.time;
    if (!this.#updateDrawn()) return this.#body.pose;
    const dated = this.#withBodyTime(frame);
    this.#body.update(dated, standIn);
    const { recording, seconds } = this.#replay;
    if (recording) void this.#body.warmUp(warmUpFrames(recording, seconds, dated.time));
    return this.#body.pose;
  }

  /** Returns whether the same recording went back: nothing may be drawn on the way from its end. */
  #hasRestarted(): boolean {
    const { recording, seconds } = this.#replay;
    return recording === this.#drawn.recording && seconds < this.#drawn.seconds;
  }

  /** Returns the frame with its time by the body's clock. */
  #withBodyTime(frame: TrackingFrame): TrackingFrame {
    return this.#pausedSeconds === 0 ? frame : { ...frame, time: frame.time - this.#pausedSeconds };
  }

  /** Stores the replay's moment and the method; returns whether either has changed. */
  #updateDrawn(): boolean {
    const moment = this.#drawn;
    const { recording, seconds } = this.#replay;
    const { estimator } = this.#body;
    if (moment.recording === recording && moment.seconds === seconds && moment.method === estimator) return false;
    moment.recording = recording;
    moment.seconds = seconds;
    moment.method = estimator;
    return true;
  }
}
