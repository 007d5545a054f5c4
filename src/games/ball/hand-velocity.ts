import { addScaled, copyVec3, lerp, type MutableVec3, scale, subtract, type Vec3, vec3, zero } from 'threepoint/math';

/** A throw has the hand's average velocity over this time [s]. */
export const throwWindow = 0.08;

/** Number of sample times on the path, which does not depend on the frame rate. */
const sampleCount = 17;

/** A gap longer than this [s] starts another path. */
const longestGap = 0.25;

interface Sample {
  time: number;
  readonly position: MutableVec3;
}

const makeSample = (): Sample => ({ time: 0, position: vec3(0, 0, 0) });

/** Measures the velocity of a hand over its recent path. */
export class HandVelocity {
  /** Oldest first. */
  readonly #path: Sample[] = [];
  /** Objects for reuse. */
  readonly #spare: Sample[] = [];
  readonly #at = vec3(0, 0, 0);

  /** Adds a position; it is copied. A time that does not rise is ignored. */
  follow(time: number, position: Vec3): void {
    const path = this.#path;
    const last = path.at(-1);
    if (last && !(time > last.time)) return;
    if (last && time - last.time > longestGap) this.reset();
    const sample = this.#spare.pop() ?? makeSample();
    sample.time = time;
    copyVec3(position, sample.position);
    path.push(sample);
    // Keep one position before the window, to interpolate at its start.
    while (path.length > 2 && path[1]!.time <= time - throwWindow) this.#spare.push(path.shift()!);
  }

  /** Returns the velocity [m/s] over the last `throwWindow`; zero with fewer than two positions. */
  velocity(): Vec3 {
    const path = this.#path;
    const last = path.at(-1);
    const first = path[0];
    if (!last || !first || path.length < 2) return zero;
    const start = Math.max(last.time - throwWindow, first.time);
    const span = last.time - start;
    const sum = vec3(0, 0, 0);
    let squares = 0;
    let segment = 0;
    for (let i = 0; i < sampleCount; i++) {
      const time = start + (span * i) / (sampleCount - 1);
      while (segment < path.length - 2 && path[segment + 1]!.time < time) segment += 1;
      const [a, b] = [path[segment]!, path[segment + 1]!];
      lerp(a.position, b.position, (time - a.time) / (b.time - a.time), this.#at);
      const fromMiddle = time - start - span / 2;
      addScaled(sum, subtract(this.#at, last.position, this.#at), fromMiddle, sum);
      squares += fromMiddle * fromMiddle;
    }
    return scale(sum, 1 / squares, sum);
  }

  reset(): void {
    while (this.#path.length > 0) this.#spare.push(this.#path.pop()!);
  }
}
