import {
  type Calibration,
  type GuidedCalibration,
  initialGuidedCalibration,
  stepGuidedCalibration,
  type TrackingFrame,
} from 'threepoint/core';
import type { CalibrationStep } from './calibration-dialog';

/** Seconds to take the posture; seconds that the closing sentence stays in the headset. */
const countdown = 3;
const closing = 4;

/** Leads through two seconds of standing still. Its clock is that of the tracked frames. */
export function createCalibrationGuide(options: {
  /** null: the guide is not running. */
  onStep(step: CalibrationStep | null): void;
  onMeasured(calibration: Calibration): void;
  /** Whether "Done" goes away by itself, as it should where there is no hand free to close it. */
  closesItself(): boolean;
}) {
  let startTime: number | null = null;
  let running = false;
  let measuring: GuidedCalibration = initialGuidedCalibration;
  let endTime: number | null = null;

  function stop(): void {
    running = false;
    options.onStep(null);
  }

  return {
    start(): void {
      running = true;
      startTime = null;
      endTime = null;
      measuring = initialGuidedCalibration;
      options.onStep({ kind: 'countdown', secondsLeft: countdown });
    },
    cancel(): void {
      if (running) stop();
    },
    /** Every tracked frame, running or not. */
    observe(frame: TrackingFrame): void {
      if (!running) return;
      startTime ??= frame.time;
      const elapsed = frame.time - startTime;
      if (endTime !== null) {
        if (options.closesItself() && frame.time - endTime > closing) stop();
        return;
      }
      if (elapsed < countdown) {
        options.onStep({ kind: 'countdown', secondsLeft: countdown - elapsed });
        return;
      }
      measuring = stepGuidedCalibration(measuring, frame);
      if (measuring.kind === 'measuring') {
        options.onStep({ kind: 'measuring', part: measuring.part });
        return;
      }
      endTime = frame.time;
      if (measuring.kind === 'failed') {
        options.onStep({ kind: 'failed', fault: measuring.fault, text: measuring.reason });
        return;
      }
      const { calibration } = measuring;
      options.onMeasured(calibration);
      const eyes = Math.round(calibration.eyeHeight * 100);
      options.onStep({ kind: 'done', text: `Your eyes are ${eyes} cm above the floor. The page stores this.` });
    },
  };
}

export type CalibrationGuide = ReturnType<typeof createCalibrationGuide>;
