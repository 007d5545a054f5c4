import { actorFrame, type Calibration, defaultCalibration, type TrackingFrame } from 'threepoint/core';

/**
 * Creates the actor, a scripted motion that moves the body while no headset is worn. Its performance starts with its
 * first frame. `isStill`: whether it stands still instead.
 */
export function createActor(isStill: () => boolean = () => false) {
  let began: number | null = null;
  let body = defaultCalibration;
  return {
    /** Returns head and hands of the performance at a time [s] on any monotonic clock. */
    frameAt(time: number): TrackingFrame {
      if (isStill()) return { ...actorFrame(0, body), time };
      began ??= time;
      return { ...actorFrame(time - began, body), time };
    },
    /** Returns head and hands of the actor standing still at a time [s]. */
    standAt: (time: number): TrackingFrame => ({ ...actorFrame(0, body), time }),
    /** The body that performs. */
    calibrate(calibration: Calibration): void {
      body = calibration;
    },
  };
}

export type Actor = ReturnType<typeof createActor>;
