import { addScaled, lerp, scale, subtract, type Vec3, zero } from '../../math/vec3';

/** The path of something over the last moments, and how fast it went. */
export interface HandSpeed {
  /** Times rise; a time that does not is ignored. */
  follow(time: number, position: Vec3): void;
  /** Velocity [m/s] over the last `throwWindow` before the newest time; zero with fewer than two places. */
  velocity(): Vec3;
  reset(): void;
}

/** A throw goes as fast as the hand did on average over this time [s]. */
export const throwWindow = 0.08;

/** Places at which the path is looked at: the same ones whatever the frame rate and whatever frames are missing. */
const places = 17;

/** A gap between two places longer than this [s] is no path. */
const longestGap = 0.25;

/**
 * The slope of the straight line that fits the path best (least squares), the path being the straight lines between the frames: so a
 * dropped frame changes no more of it than what the hand did off that line.
 */
export function createHandSpeed(): HandSpeed {
  let path: { readonly time: number; readonly position: Vec3 }[] = [];

  return {
    follow(time, position) {
      const last = path.at(-1);
      if (last && !(time > last.time)) return;
      if (last && time - last.time > longestGap) path = [];
      path.push({ time, position });
      // One place from before the window is needed, to know where the path enters it.
      while (path.length > 2 && path[1]!.time <= time - throwWindow) path.shift();
    },
    velocity() {
      const last = path.at(-1);
      const first = path[0];
      if (!last || !first || path.length < 2) return zero;
      const start = Math.max(last.time - throwWindow, first.time);
      const span = last.time - start;
      let sum = zero;
      let squares = 0;
      let segment = 0;
      for (let i = 0; i < places; i++) {
        const time = start + (span * i) / (places - 1);
        while (segment < path.length - 2 && path[segment + 1]!.time < time) segment += 1;
        const [a, b] = [path[segment]!, path[segment + 1]!];
        const at = lerp(a.position, b.position, (time - a.time) / (b.time - a.time));
        const fromMiddle = time - start - span / 2;
        sum = addScaled(sum, subtract(at, last.position), fromMiddle);
        squares += fromMiddle * fromMiddle;
      }
      return scale(sum, 1 / squares);
    },
    reset() {
      path = [];
    },
  };
}
