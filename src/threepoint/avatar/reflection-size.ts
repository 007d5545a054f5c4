/**
 * A reflection has at most this share of the pixels of the picture that it is part of. A mirror of 1.5 × 2.15 m seen
 * from 1.5 m fills less than a third of an eye of 96°.
 */
const pixelShare = 0.4;

/** The size of a texture [pixels]. */
export interface TextureSize {
  readonly width: number;
  readonly height: number;
}

/** The sizes of the newest calls, so that a frame makes no garbage. */
const size = { width: 0, height: 0 };

/**
 * Returns the size of the reflection in a picture of this many pixels, for a glass of this height to width, at most so
 * wide [pixels]. The next call overwrites it.
 */
export function reflectionSize(pixels: number, heightToWidth: number, mostWidth: number): TextureSize {
  const width = Math.floor(Math.min(mostWidth, Math.sqrt((pixelShare * pixels) / heightToWidth)));
  size.width = width;
  size.height = Math.floor(width * heightToWidth);
  return size;
}

/** Frames that come a little early are due all the same [s]. */
const early = 0.001;

/** Chooses the frames in which something is due that happens less often than frames do. */
export class Pace {
  /** The most often that something is due [Hz]; null: in each frame. */
  rateHz: number | null = null;
  #next = Number.NEGATIVE_INFINITY;

  /** Makes the next frame due. */
  restart(): void {
    this.#next = Number.NEGATIVE_INFINITY;
  }

  /** Returns whether something is due in the frame at this time [s]; each frame is asked about once. */
  isDue(time: number): boolean {
    if (this.rateHz === null) return true;
    const interval = 1 / this.rateHz;
    const wait = this.#next - time;
    // A wait longer than an interval is that of a clock that was set back.
    if (wait > early && wait <= interval) return false;
    this.#next = wait > -interval && wait <= early ? this.#next + interval : time + interval;
    return true;
  }
}
