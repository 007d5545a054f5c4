import type { Calibration } from '../../core/body/calibration';
import {
  parseRecording,
  type Recording,
  recordingDuration,
  sampleRecording,
  writeRecording,
} from '../../core/tracking/recording';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';

/** Frames kept at most: a quarter of an hour at 120 Hz, some 50 MB. Longer recordings stop by themselves. */
const most = 108_000;

/** Keeps tracked frames and plays them back; one recording at hand at a time. Times are seconds of whoever calls. */
export interface Recorder {
  readonly mode: 'idle' | 'recording' | 'replaying';
  readonly loop: boolean;
  /** Seconds since recording or replay began. */
  readonly seconds: number;
  /** Of the recording at hand [s]; 0 without one. */
  readonly duration: number;
  readonly frameCount: number;
  /** null: no recording at hand. */
  readonly name: string | null;
  setLoop(loop: boolean): void;
  /** A new recording; the one at hand is forgotten. */
  record(source: { readonly device: string; readonly rateHz: number; readonly calibration: Calibration }): void;
  /** Every tracked frame, recording or not. */
  observe(frame: TrackingFrame): void;
  /** Ends recording or replay. */
  stop(): void;
  /** Plays the recording at hand from its beginning; nothing happens without one. */
  replay(): void;
  /** The replay's frame at this time, dated at this time; null: nothing is replayed. */
  sample(time: number): TrackingFrame | null;
  /** Takes a recording from the text of a file; throws a sentence when it is none. */
  open(name: string, text: string): Recording;
  /** The file of the recording at hand; null without one. */
  file(): { readonly name: string; readonly text: string } | null;
}

export function createRecorder(): Recorder {
  let mode: Recorder['mode'] = 'idle';
  let loop = true;
  let recording: Recording | null = null;
  let name: string | null = null;
  let frames: TrackingFrame[] = [];
  let about: Omit<Recording, 'frames'> = { device: '', rateHz: 60, calibration: null };
  let startTime: number | null = null;
  let seconds = 0;
  let count = 0;

  function stop(): void {
    if (mode === 'recording' && frames.length > 0) {
      recording = { ...about, frames };
      count += 1;
      name = `recording-${count}.json`;
    }
    frames = [];
    mode = 'idle';
    seconds = 0;
    startTime = null;
  }

  return {
    get mode() {
      return mode;
    },
    get loop() {
      return loop;
    },
    get seconds() {
      return seconds;
    },
    get duration() {
      return recording ? recordingDuration(recording) : 0;
    },
    get frameCount() {
      return mode === 'recording' ? frames.length : (recording?.frames.length ?? 0);
    },
    get name() {
      return name;
    },
    setLoop(next) {
      loop = next;
    },
    record(source) {
      stop();
      about = source;
      recording = null;
      name = null;
      mode = 'recording';
    },
    observe(frame) {
      if (mode !== 'recording') return;
      const last = frames.at(-1);
      if (last && frame.time <= last.time) return;
      frames.push(frame);
      seconds = frame.time - (frames[0]?.time ?? frame.time);
      if (frames.length >= most) stop();
    },
    stop,
    replay() {
      if (!recording) return;
      stop();
      mode = 'replaying';
    },
    sample(time) {
      const first = recording?.frames[0];
      if (mode !== 'replaying' || !recording || !first) return null;
      startTime ??= time;
      const duration = recordingDuration(recording);
      if (time - startTime > duration) {
        if (loop) startTime = time;
        else {
          stop();
          return null;
        }
      }
      seconds = time - startTime;
      return { ...sampleRecording(recording, first.time + seconds), time };
    },
    open(fileName, text) {
      const read = parseRecording(text);
      stop();
      recording = read;
      name = fileName;
      return read;
    },
    file: () => (recording && name ? { name, text: writeRecording(recording) } : null),
  };
}
