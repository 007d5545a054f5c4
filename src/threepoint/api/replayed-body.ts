import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import type { PaperMethod } from '../core/estimation/pose-estimator';
import { type Replayable, sampleRecording } from '../core/tracking/recording';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import type { Body } from './body';

/** The state of a replay that may move a body. */
export interface ReplayState {
  readonly mode: 'idle' | 'recording' | 'replaying';
  readonly paused: boolean;
  /** The position in the recording [s]. */
  readonly seconds: number;
  /** The recording; null: none is loaded. */
  readonly recording: Replayable | null;
}

/** The length [s] of the recording before the current position with which a body is warmed up. */
const warmUpSeconds = 5;
/** The highest frame rate of the warm-up [Hz]; recordings with a higher rate are resampled. */
const maxWarmUpHz = 60;

/** Yields the last frames of a recording up to the position `seconds` [s], which gets the time `time` [s]. */
function* warmUpFrames(recording: Replayable, seconds: number, time: number): Generator<TrackingFrame> {
  const first = recording.frames.at(0)!.time;
  const rateHz = Math.min(recording.rateHz, maxWarmUpHz);
  for (let left = Math.floor(Math.min(warmUpSeconds, seconds) * rateHz); left >= 0; left--) {
    const before = left / rateHz;
    yield { ...sampleRecording(recording, first + seconds - before), time: time - before };
  }
}

type DrivenBody = Pick<Body<PaperMethod>, 'solve' | 'warmUp' | 'discontinuity' | 'pose' | 'estimator'>;

/**
 * Drives a body by a replay. While the replay is paused, the body's time stands still and its state does not change.
 * After a seek in a paused replay, or a change of the estimator, the body is warmed up with the frames before the
 * position.
 */
export class ReplayedBody {
  readonly #body: DrivenBody;
  readonly #replay: ReplayState;
  /** The total of the pauses since the replay started [s]. */
  #pausedSeconds = 0;
  /** The time of the newest frame, by the page's clock [s]. */
  #time = Number.NaN;
  /** The position and the estimator of the drawn pose. */
  readonly #drawn: { recording: Replayable | null; seconds: number; estimator: string } = {
    recording: null,
    seconds: 0,
    estimator: '',
  };

  constructor(body: DrivenBody, replay: ReplayState) {
    this.#body = body;
    this.#replay = replay;
  }

  update(frame: TrackingFrame | null, standIn: Calibration | null): AvatarPose | null {
    const { mode, paused } = this.#replay;
    if (!frame || mode !== 'replaying') {
      this.stop();
      return this.#body.solve(frame, standIn);
    }
    if (paused) return this.#updatePaused(frame, standIn);
    this.#time = frame.time;
    if (this.#hasRestarted()) this.#body.discontinuity();
    const pose = this.#body.solve(this.#withBodyTime(frame), standIn);
    this.#updateDrawn();
    return pose;
  }

  /** Resets the state: no replay moves the body. */
  stop(): void {
    this.#pausedSeconds = 0;
    this.#drawn.recording = null;
  }

  #updatePaused(frame: TrackingFrame, standIn: Calibration | null): AvatarPose | null {
    if (this.#drawn.recording) this.#pausedSeconds += frame.time - this.#time;
    this.#time = frame.time;
    if (!this.#updateDrawn()) return this.#body.pose;
    const solved = this.#withBodyTime(frame);
    this.#body.solve(solved, standIn);
    const { recording, seconds } = this.#replay;
    if (recording) void this.#body.warmUp(warmUpFrames(recording, seconds, solved.time));
    return this.#body.pose;
  }

  /** Returns whether the position in the same recording went back, which is a discontinuity. */
  #hasRestarted(): boolean {
    const { recording, seconds } = this.#replay;
    return recording === this.#drawn.recording && seconds < this.#drawn.seconds;
  }

  /** Returns the frame with its time on the body's clock, which skips pauses. */
  #withBodyTime(frame: TrackingFrame): TrackingFrame {
    return this.#pausedSeconds === 0 ? frame : { ...frame, time: frame.time - this.#pausedSeconds };
  }

  /** Stores the replay's position and the estimator; returns whether either has changed. */
  #updateDrawn(): boolean {
    const { recording, seconds } = this.#replay;
    const { estimator } = this.#body;
    const drawn = this.#drawn;
    if (drawn.recording === recording && drawn.seconds === seconds && drawn.estimator === estimator) return false;
    drawn.recording = recording;
    drawn.seconds = seconds;
    drawn.estimator = estimator;
    return true;
  }
}
