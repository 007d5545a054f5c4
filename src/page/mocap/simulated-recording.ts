import type { Replayable, TrackingFrame, TrackingFrames } from 'threepoint/core';
import { type MocapClip, mocapRateHz, trackedWidth } from 'threepoint/internal';
import { normaliseQuat, quat, type TrackedPose, vec3 } from 'threepoint/math';

/** The tracking of a clip. Frames are computed on request and not kept: half an hour of them would block the page. */
class SimulatedFrames implements TrackingFrames {
  readonly length: number;
  readonly #numbers: Float32Array;

  constructor({ tracked, frameCount }: MocapClip) {
    this.#numbers = tracked;
    this.length = frameCount;
  }

  at(index: number): TrackingFrame | undefined {
    const frame = index < 0 ? this.length + index : index;
    if (!(frame >= 0 && frame < this.length)) return undefined;
    const from = frame * trackedWidth;
    return {
      time: frame / mocapRateHz,
      head: this.#pose(from),
      leftHand: this.#pose(from + 7),
      rightHand: this.#pose(from + 14),
    };
  }

  *[Symbol.iterator](): Generator<TrackingFrame> {
    for (let frame = 0; frame < this.length; frame++) yield this.at(frame)!;
  }

  #pose(from: number): TrackedPose {
    const number = (index: number): number => this.#numbers[from + index]!;
    const orientation = quat(number(3), number(4), number(5), number(6));
    return {
      position: vec3(number(0), number(1), number(2)),
      // Single precision leaves quaternions a little off their length.
      orientation: normaliseQuat(orientation, orientation),
      tracking: 'tracked',
    };
  }
}

/** Returns the simulated tracking of a clip as a recording that any method replays. */
export const recordingOf = (clip: MocapClip): Replayable => ({
  device: 'simulated from motion capture',
  rateHz: mocapRateHz,
  calibration: clip.calibration,
  frames: new SimulatedFrames(clip),
});
