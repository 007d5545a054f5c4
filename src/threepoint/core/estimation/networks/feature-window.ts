import { featureCount } from './frame-features';

interface TimedFeatures {
  time: number;
  readonly features: Float32Array;
}

/** A history of features that is read at ages in seconds, so that a window means the same at 60, 72 and 120 Hz. */
export class FeatureWindow {
  /** The frames, oldest first; dropped buffers are reused. */
  readonly #frames: TimedFeatures[] = [];
  readonly #spare: TimedFeatures[] = [];
  readonly #longestAge: number;
  readonly #width: number;

  /** `width`: the number of features of a frame. */
  constructor(longestAgeSeconds: number, width: number = featureCount) {
    this.#longestAge = longestAgeSeconds;
    this.#width = width;
  }

  /** Returns the buffer of a new frame for its features; a time that does not advance replaces the newest frame. */
  push(time: number): Float32Array {
    const frames = this.#frames;
    const newest = frames.at(-1);
    if (newest && time < newest.time - this.#longestAge) this.clear();
    while (frames.length > 0 && frames.at(-1)!.time >= time) this.#spare.push(frames.pop()!);
    const frame = this.#spare.pop() ?? { time, features: new Float32Array(this.#width) };
    frame.time = time;
    frames.push(frame);
    // One frame beyond the longest age stays, to interpolate from.
    while (frames.length > 2 && frames[1]!.time < time - this.#longestAge) this.#spare.push(frames.shift()!);
    return frame.features;
  }

  /**
   * Writes the features at `ages` [s] before the newest frame, one after the other; linear between frames, the oldest
   * before the start.
   */
  read(ages: readonly number[], target: Float32Array): void {
    const frames = this.#frames;
    const width = this.#width;
    const newest = frames.at(-1);
    if (!newest) {
      target.fill(0, 0, ages.length * width);
      return;
    }
    for (let slot = 0; slot < ages.length; slot++) {
      const wanted = Math.max(newest.time - ages[slot]!, frames[0]!.time);
      let after = frames.length - 1;
      while (after > 0 && frames[after - 1]!.time >= wanted) after -= 1;
      const late = frames[after]!;
      const early = frames[Math.max(0, after - 1)]!;
      const gap = late.time - early.time;
      const fraction = gap > 0 ? (wanted - early.time) / gap : 1;
      const from = slot * width;
      for (let i = 0; i < width; i++) {
        target[from + i] = early.features[i]! * (1 - fraction) + late.features[i]! * fraction;
      }
    }
  }

  clear(): void {
    while (this.#frames.length > 0) this.#spare.push(this.#frames.pop()!);
  }
}
