import {
  type Calibration,
  calibrationProblem,
  copyFingers,
  parseRecording,
  type Replayable,
  recordingDuration,
  sampleRecording,
  type TrackingFrame,
  writeRecording,
} from 'threepoint/core';

/**
 * Frames kept at most: a quarter of an hour at 120 Hz, some 50 MB, with a device's body 100. Longer recordings stop by
 * themselves.
 */
const maxFrames = 108_000;

/** Keeps tracked frames and replays them, one recording at a time. Times are seconds of the caller's clock. */
export class Recorder {
  #mode: 'idle' | 'recording' | 'replaying' = 'idle';
  #loop = true;
  #recording: Replayable | null = null;
  #name: string | null = null;
  /** The name of its download, which is never that of a file that was opened. */
  #fileName = '';
  #frames: TrackingFrame[] = [];
  #about: Omit<Replayable, 'frames'> = { device: '', rateHz: 60, calibration: null };
  /** The time of the last request for a frame of the replay; null: none yet. */
  #sampledAt: number | null = null;
  #seconds = 0;
  #paused = false;
  /** The number of recordings made. */
  #count = 0;
  /** The number of requests for a recording, and that of the current one. */
  #requests = 0;
  #newest = 0;
  readonly #onEnd: () => void;

  /** `onEnd` is called when a recording is full or a replay has ended by itself. */
  constructor(onEnd: () => void = () => undefined) {
    this.#onEnd = onEnd;
  }

  get mode(): 'idle' | 'recording' | 'replaying' {
    return this.#mode;
  }

  /** The calibration of the person in the replayed recording; null: there is no replay, or it has no calibration. */
  get person(): Calibration | null {
    return this.#mode === 'replaying' ? (this.#recording?.calibration ?? null) : null;
  }

  get recording(): Replayable | null {
    return this.#recording;
  }

  get loop(): boolean {
    return this.#loop;
  }

  get paused(): boolean {
    return this.#paused;
  }

  /** Seconds since recording or replay began. */
  get seconds(): number {
    return this.#seconds;
  }

  /** The length of the current recording [s]; 0 without one. */
  get duration(): number {
    return this.#recording ? recordingDuration(this.#recording) : 0;
  }

  get frameCount(): number {
    return this.#mode === 'recording' ? this.#frames.length : (this.#recording?.frames.length ?? 0);
  }

  get name(): string | null {
    return this.#name;
  }

  setLoop(loop: boolean): void {
    this.#loop = loop;
  }

  /** Starts a new recording, which replaces the current one. `source`: its header. */
  record(source: Omit<Replayable, 'frames'>): void {
    this.stop();
    this.#newest = this.nextRequest();
    this.#about = source;
    this.#recording = null;
    this.#name = null;
    this.#mode = 'recording';
  }

  /** Records a tracked frame while a recording is in progress. */
  observe(frame: TrackingFrame): void {
    if (this.#mode !== 'recording') return;
    const last = this.#frames.at(-1);
    if (last && frame.time <= last.time) return;
    const { fingers, deviceBody } = frame;
    this.#frames.push({
      ...frame,
      ...(fingers && { fingers: copyFingers(fingers) }),
      ...(deviceBody && { deviceBody: deviceBody.slice() }),
    });
    this.#seconds = frame.time - (this.#frames[0]?.time ?? frame.time);
    if (this.#frames.length >= maxFrames) this.#end();
  }

  stop(): void {
    if (this.#mode === 'recording' && this.#frames.length > 0) {
      this.#recording = { ...this.#about, frames: this.#frames };
      this.#count += 1;
      this.#name = `recording-${this.#count}.json`;
      this.#fileName = this.#name;
    }
    this.#frames = [];
    this.#mode = 'idle';
    this.#seconds = 0;
    this.#paused = false;
    this.#sampledAt = null;
  }

  /** Ends a replay, if there is one: another source moves the body. */
  endReplay(): void {
    if (this.#mode === 'replaying') this.#end();
  }

  #end(): void {
    this.stop();
    this.#onEnd();
  }

  /** Replays the current recording from its start. Does nothing without one. */
  replay(): void {
    if (!this.#recording) return;
    this.stop();
    this.#mode = 'replaying';
  }

  /** Returns the replay's frame with this time; null: there is no replay. */
  sample(time: number): TrackingFrame | null {
    const recording = this.#recording;
    const first = recording?.frames.at(0);
    if (this.#mode !== 'replaying' || !recording || !first) return null;
    if (!this.#paused) this.#seconds += time - (this.#sampledAt ?? time);
    this.#sampledAt = time;
    if (this.#seconds > recordingDuration(recording)) {
      if (!this.#loop) {
        this.#end();
        return null;
      }
      this.#seconds = 0;
    }
    return { ...sampleRecording(recording, first.time + this.#seconds), time };
  }

  setPaused(on: boolean): void {
    this.#paused = on && this.#mode === 'replaying';
  }

  /** Replays the current recording from this second on, or shows this second if the replay is paused. */
  seek(seconds: number): void {
    if (this.#mode !== 'replaying') this.replay();
    if (this.#mode === 'replaying') this.#seconds = Math.max(0, Math.min(this.duration, seconds));
  }

  /** Loads a recording from the text of a file. Throws a sentence if it is invalid, and as `load` does. */
  open(name: string, text: string, requestNumber = this.nextRequest()): Replayable {
    const recording = parseRecording(text);
    const complaint = recording.calibration && calibrationProblem(recording.calibration);
    if (complaint) throw new Error(complaint);
    this.load(name, recording, requestNumber);
    return recording;
  }

  /**
   * Returns the number of a new request for a recording. A recording that loads slowly is discarded if a newer request
   * has been met.
   */
  nextRequest(): number {
    this.#requests += 1;
    return this.#requests;
  }

  /**
   * Loads a recording, which replaces the current one. Throws while another is being recorded, and if a later request
   * has been met.
   */
  load(name: string, recording: Replayable, requestNumber = this.nextRequest()): void {
    if (this.#mode === 'recording') throw new Error('a recording is in progress; stop it first');
    if (requestNumber < this.#newest) throw new Error('a newer recording was opened');
    this.stop();
    this.#newest = requestNumber;
    this.#recording = recording;
    this.#name = name;
    this.#fileName = `${name.replace(/\.json$/i, '')}-tracking.json`;
  }

  /** Returns the file of the current recording, or null without one. */
  file(): { readonly name: string; readonly text: string } | null {
    return this.#recording && { name: this.#fileName, text: writeRecording(this.#recording) };
  }
}
