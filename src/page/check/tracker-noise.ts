import {
  conjugate,
  length,
  median,
  multiply,
  type Pose,
  type Quat,
  subtract,
  toRotationVector,
  type Vec3,
} from 'threepoint/math';

/** The second time scale [s]; the first is one frame. */
const slowLag = 0.1;
/** The length of a window [s]: the median of the windows counts, so a movement in fewer than half of them does not. */
const windowSeconds = 0.5;
/** A figure needs this many windows, and a window this many second differences. */
const fewestWindows = 4;
const fewestInWindow = 8;
/** A second difference counts where both of its intervals deviate from the lag by less than this share of a frame. */
const intervalTolerance = 0.35;
/** A tracker is at rest if its median speed over `slowLag` is lower: by direction [m/s], and by turning [rad/s]. */
const [restSpeed, restTurn] = [0.1, 0.5];

/** The standard deviations of one quantity, by axis or by component of a rotation vector. */
interface NoiseLevels {
  /** White noise from frame to frame. */
  readonly frame: number;
  /** The noise at a lag of 0.1 s. It is larger than `frame` where the device smooths its noise. */
  readonly slow: number;
  /** Slow movement of the person: what remains beside `frame` after the mean and a constant drift are removed. */
  readonly sway: number;
}

/** The noise of one tracker at rest. */
export interface NoiseFigures {
  readonly frames: number;
  /** The share of frames that repeat the position of the frame before exactly. */
  readonly repeated: number;
  readonly positionMm: NoiseLevels;
  readonly rotationDegrees: NoiseLevels;
}

/**
 * Measures the noise of a tracker that is held still.
 *
 * Noise is the root mean square of second differences x(t + lag) − 2 x(t) + x(t − lag), divided by √6: white noise
 * of deviation s gives s, a constant velocity gives 0. A sway of amplitude a and frequency f adds a (2π f lag)² / √12:
 * 10 mm at 0.5 Hz and 72 Hz add 0.005 mm. Tremor of 8 to 12 Hz is as quick as noise and is counted with it.
 */
export class TrackerNoise {
  readonly #times: number[] = [];
  readonly #positions: Vec3[] = [];
  readonly #orientations: Quat[] = [];

  /** Adds the pose [m] of a frame at this time [s]. Frames in which the tracker is not seen are left out. */
  add(time: number, { position, orientation }: Pose<'floor'>): void {
    this.#times.push(time);
    this.#positions.push({ ...position });
    this.#orientations.push({ ...orientation });
  }

  /** The number of frames in which the tracker was seen. */
  get frames(): number {
    return this.#times.length;
  }

  /** Whether the tracker moved for most of the time. A glance aside is no such movement. */
  get moved(): boolean {
    if (this.frames < 3) return false;
    return this.#medianSpeed(this.#moved) > restSpeed || this.#medianSpeed(this.#turned) > restTurn;
  }

  /** Returns the figures; null: it moved, or too few frames at a steady rate, of which two seconds are needed. */
  figures(): NoiseFigures | null {
    const times = this.#times;
    if (this.frames < 3 || this.moved) return null;
    const interval = this.#interval;
    if (!(interval > 0)) return null;
    const position = this.#levels(this.#moved, interval);
    const rotation = this.#levels(this.#turned, interval);
    if (!position || !rotation) return null;
    const repeats = this.#positions.filter(({ x, y, z }, index) => {
      const before = this.#positions[index - 1];
      return before !== undefined && before.x === x && before.y === y && before.z === z;
    });
    return {
      frames: times.length,
      repeated: repeats.length / (times.length - 1),
      positionMm: scaled(position, 1000),
      rotationDegrees: scaled(rotation, 180 / Math.PI),
    };
  }

  readonly #moved: Change = (from, to) => subtract(this.#positions[to]!, this.#positions[from]!);
  readonly #turned: Change = (from, to) => rotationFrom(this.#orientations[from]!, this.#orientations[to]!);

  /** The median time from a frame to the next [s]. */
  get #interval(): number {
    const times = this.#times;
    return median(times.slice(1).map((time, index) => time - times[index]!));
  }

  /** Returns the median speed over `slowLag` [1/s]; 0 without frames that far apart. */
  #medianSpeed(change: Change): number {
    const times = this.#times;
    const lag = Math.max(1, Math.round(slowLag / this.#interval));
    const speeds = times.slice(lag).map((time, from) => length(change(from, from + lag)) / (time - times[from]!));
    return speeds.length > 0 ? median(speeds) : 0;
  }

  #levels(change: Change, interval: number): NoiseLevels | null {
    const frame = this.#noiseAt(change, 1, interval);
    const slow = this.#noiseAt(change, Math.max(1, Math.round(slowLag / interval)), interval);
    if (frame === null || slow === null) return null;
    const remaining = residualVariance(
      this.#times,
      this.#times.map((_, index) => change(0, index)),
    );
    return { frame, slow, sway: Math.sqrt(Math.max(0, remaining - frame ** 2)) };
  }

  /** Returns the deviation at a lag of so many frames; null: there are too few windows. */
  #noiseAt(change: Change, lag: number, interval: number): number | null {
    const times = this.#times;
    const windows = new Map<number, { sum: number; count: number }>();
    const apart = (from: number, to: number) =>
      Math.abs(times[to]! - times[from]! - lag * interval) < intervalTolerance * interval;
    for (let middle = lag; middle + lag < times.length; middle++) {
      if (!apart(middle - lag, middle) || !apart(middle, middle + lag)) continue;
      const { x, y, z } = subtract(change(middle, middle + lag), change(middle - lag, middle));
      const number = Math.floor((times[middle]! - times[0]!) / windowSeconds);
      const window = windows.get(number) ?? { sum: 0, count: 0 };
      window.sum += x * x + y * y + z * z;
      window.count += 1;
      windows.set(number, window);
    }
    const squares = [...windows.values()].filter(({ count }) => count >= fewestInWindow);
    if (squares.length < fewestWindows) return null;
    return Math.sqrt(median(squares.map(({ sum, count }) => sum / (3 * count))) / 6);
  }
}

/** The change of a quantity from one sample to another. */
type Change = (from: number, to: number) => Vec3;

/** Returns the rotation vector [rad] that leads from one orientation to the other, in the axes of the first. */
const rotationFrom = (from: Quat, to: Quat): Vec3 => toRotationVector(multiply(conjugate(from), to));

/** Returns the variance by axis that remains after a straight line is removed from each axis. */
function residualVariance(times: readonly number[], values: readonly Vec3[]): number {
  const count = times.length;
  const middle = times.reduce((sum, time) => sum + time, 0) / count;
  const spread = times.reduce((sum, time) => sum + (time - middle) ** 2, 0);
  let squares = 0;
  for (const axis of ['x', 'y', 'z'] as const) {
    const mean = values.reduce((sum, value) => sum + value[axis], 0) / count;
    const slope = values.reduce((sum, value, index) => sum + (times[index]! - middle) * value[axis], 0) / spread;
    values.forEach((value, index) => {
      squares += (value[axis] - mean - slope * (times[index]! - middle)) ** 2;
    });
  }
  return squares / (3 * count);
}

const scaled = ({ frame, slow, sway }: NoiseLevels, factor: number): NoiseLevels => ({
  frame: frame * factor,
  slow: slow * factor,
  sway: sway * factor,
});
