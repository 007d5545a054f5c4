import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import { type Replayable, sampleRecording } from '../core/tracking/recording';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import type { BodySolver } from './body-solver';

/** A replay that may move a body. */
export interface MovingReplay {
  readonly mode: 'idle' | 'recording' | 'replaying';
  /** Whether it stands still. */
  readonly paused: boolean;
  /** Where it is [s]. */
  readonly seconds: number;
  /** null: none is at hand. */
  readonly recording: Replayable | null;
}

/** A body lives through so many seconds before a moment to stand in it as one that came there moving. */
const leadSeconds = 5;
/** Frames per second of the lead at most, however many a file has. */
const mostHz = 60;

/** Frames of a recording up to this second of it, which is dated `time` [s]. */
export function* leadUpTo(recording: Replayable, seconds: number, time: number): Generator<TrackingFrame> {
  const first = recording.frames.at(0)!.time;
  const rateHz = Math.min(recording.rateHz, mostHz);
  for (let left = Math.floor(Math.min(leadSeconds, seconds) * rateHz); left >= 0; left--) {
    const before = left / rateHz;
    yield { ...sampleRecording(recording, first + seconds - before), time: time - before };
  }
}

/**
 * A body that a replay may move. While the replay stands still, so does the body's time: nothing that it knows of the motion fades. Where the
 * replay stands at another second, or another method draws, the body lives through the seconds before.
 */
export class ReplayedBody {
  readonly #body: Pick<BodySolver, 'update' | 'warmUp' | 'discontinuity' | 'pose' | 'estimator'>;
  readonly #replay: MovingReplay;
  /** How long replays stood still since the last one began [s]. */
  #stood = 0;
  /** Of the newest frame, by the page's clock [s]. */
  #time = Number.NaN;
  /** What the body stands in. */
  readonly #moment: { recording: Replayable | null; seconds: number; method: string } = {
    recording: null,
    seconds: 0,
    method: '',
  };

  constructor(
    body: Pick<BodySolver, 'update' | 'warmUp' | 'discontinuity' | 'pose' | 'estimator'>,
    replay: MovingReplay,
  ) {
    this.#body = body;
    this.#replay = replay;
  }

  /** One frame of tracking, as `update` of the body. */
  update(frame: TrackingFrame | null, standIn: Calibration | null): AvatarPose | null {
    const { mode, paused } = this.#replay;
    if (!frame || mode !== 'replaying') {
      this.stop();
      return this.#body.update(frame, standIn);
    }
    if (paused) return this.#stand(frame, standIn);
    this.#time = frame.time;
    if (this.#beginsAnew()) this.#body.discontinuity();
    const pose = this.#body.update(this.#dated(frame), standIn);
    this.#arrive();
    return pose;
  }

  /** Forgets the replay that moved the body. */
  stop(): void {
    this.#stood = 0;
    this.#moment.recording = null;
  }

  #stand(frame: TrackingFrame, standIn: Calibration | null): AvatarPose | null {
    if (this.#moment.recording) this.#stood += frame.time - this.#time;
    this.#time = frame.time;
    if (!this.#arrive()) return this.#body.pose;
    const dated = this.#dated(frame);
    this.#body.update(dated, standIn);
    const { recording, seconds } = this.#replay;
    if (recording) void this.#body.warmUp(leadUpTo(recording, seconds, dated.time));
    return this.#body.pose;
  }

  /** Whether the same recording is at an earlier second than before: no body is drawn on the way from its end. */
  #beginsAnew(): boolean {
    const { recording, seconds } = this.#replay;
    return recording === this.#moment.recording && seconds < this.#moment.seconds;
  }

  /** The same by the body's clock. */
  #dated(frame: TrackingFrame): TrackingFrame {
    return this.#stood === 0 ? frame : { ...frame, time: frame.time - this.#stood };
  }

  /** Notes where the replay is and what draws it; whether either is another than before. */
  #arrive(): boolean {
    const moment = this.#moment;
    const { recording, seconds } = this.#replay;
    const { estimator } = this.#body;
    if (moment.recording === recording && moment.seconds === seconds && moment.method === estimator) return false;
    moment.recording = recording;
    moment.seconds = seconds;
    moment.method = estimator;
    return true;
  }
}
