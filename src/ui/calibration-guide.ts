import type { Calibration } from '../core/body/calibration';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import type { CalibrationStep } from './calibration-dialog';

/** Seconds to take the posture, seconds to hold it, seconds that "Done" stays in the headset. */
const countdown = 3;
const measuring = 2;
const closing = 3;

export interface CalibrationGuideOptions {
  /** The person in these frames; throws a sentence that says what to do differently. */
  measure(frames: readonly TrackingFrame[]): Calibration;
  /** null: the guide is not running. */
  onStep(step: CalibrationStep | null): void;
  onMeasured(calibration: Calibration): void;
  /** Whether "Done" goes away by itself, as it should where there is no hand free to close it. */
  closesItself(): boolean;
}

/** Leads through two seconds of standing still. Its clock is that of the tracked frames. */
export interface CalibrationGuide {
  readonly running: boolean;
  start(): void;
  cancel(): void;
  /** Every tracked frame, running or not. */
  observe(frame: TrackingFrame): void;
}

export function createCalibrationGuide(options: CalibrationGuideOptions): CalibrationGuide {
  let startTime: number | null = null;
  let running = false;
  let endTime: number | null = null;
  let frames: TrackingFrame[] = [];

  function finish(time: number): void {
    endTime = time;
    try {
      const calibration = options.measure(frames);
      options.onMeasured(calibration);
      const eyes = Math.round(calibration.eyeHeight * 100);
      options.onStep({ kind: 'done', text: `Your eyes are ${eyes} cm above the floor. This is remembered.` });
    } catch (error) {
      options.onStep({ kind: 'failed', text: error instanceof Error ? error.message : String(error) });
    }
  }

  function stop(): void {
    running = false;
    frames = [];
    options.onStep(null);
  }

  return {
    get running() {
      return running;
    },
    start() {
      running = true;
      startTime = null;
      endTime = null;
      frames = [];
      options.onStep({ kind: 'countdown', secondsLeft: countdown });
    },
    cancel() {
      if (running) stop();
    },
    observe(frame) {
      if (!running) return;
      startTime ??= frame.time;
      const elapsed = frame.time - startTime;
      if (endTime !== null) {
        if (options.closesItself() && frame.time - endTime > closing) stop();
      } else if (elapsed < countdown) {
        options.onStep({ kind: 'countdown', secondsLeft: countdown - elapsed });
      } else if (elapsed < countdown + measuring) {
        frames.push(frame);
        options.onStep({ kind: 'measuring', part: (elapsed - countdown) / measuring });
      } else {
        finish(frame.time);
      }
    },
  };
}
