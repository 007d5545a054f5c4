import {
  addScaled,
  copyVec3,
  lerp,
  type MutableVec3,
  scale,
  subtract,
  type Vec3,
  vec3,
  zero,
} from 'threepoint/core/math/vec3';

/** The path of something over the last moments, and how fast it went. */
export interface HandSpeed {
  /** Times rise; a time that does not is ignored. The position is copied. */
  follow(time: number, position: Vec3): void;
  /** Velocity [m/s] over the last `throwWindow` before the newest time; zero with fewer than two places. */
  velocity(): Vec3;
  reset(): void;
}

/** A throw goes as fast as the hand did on average over this time [s]. */
export const throwWindow = 0.08;

/** Places at which the path is looked at: the same ones at every frame rate, and with every frame that is missing. */
const places = 17;

/** A gap between two places longer than this [s] is no path. */
const longestGap = 0.25;

interface Place {
  time: number;
  readonly position: MutableVec3;
}

const makePlace = (): Place => ({ time: 0, position: vec3(0, 0, 0) });

/**
 * The slope of the straight line that fits the path best (least squares), the path being the straight lines between the frames: so a
 * dropped frame changes no more of it than what the hand did off that line.
 */
class PathSpeed implements HandSpeed {
  /** Oldest first. */
  readonly #path: Place[] = [];
  /** Places of the past, for those to come. */
  readonly #spare: Place[] = [];
  readonly #at = vec3(0, 0, 0);

  follow(time: number, position: Vec3): void {
    const path = this.#path;
    const last = path.at(-1);
    if (last && !(time > last.time)) return;
    if (last && time - last.time > longestGap) this.reset();
    const place = this.#spare.pop() ?? makePlace();
    place.time = time;
    copyVec3(position, place.position);
    path.push(place);
    // One place from before the window is needed, to know where the path enters it.
    while (path.length > 2 && path[1]!.time <= time - throwWindow) this.#spare.push(path.shift()!);
  }

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
    for (let i = 0; i < places; i++) {
      const time = start + (span * i) / (places - 1);
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

export const createHandSpeed = (): HandSpeed => new PathSpeed();
