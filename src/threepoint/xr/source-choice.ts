import type { TrackedPose } from '../core/math/pose';
import { angleBetween, copyQuat, type MutableQuat } from '../core/math/quat';
import { copyVec3, distance, type MutableVec3 } from '../core/math/vec3';

/** A source moves when it leaves the place of its last movement by more than this [m, rad]: noise at rest is less. */
const movedBy = 0.015;
const turnedBy = (5 * Math.PI) / 180;
/** The source in use stays in use for this time [s] after its last movement. */
const keptSeconds = 0.5;

interface SourceReading {
  readonly source: XRInputSource;
  readonly pose: TrackedPose;
  /** A bare hand, as opposed to a controller. */
  readonly isHand: boolean;
}

/** The place [floor frame] and the time [s] of a source's last movement; −∞: it has not moved yet. */
interface Movement {
  readonly position: MutableVec3;
  readonly orientation: MutableQuat;
  time: number;
}

/**
 * Chooses one of the input sources that a device reports for the same side. A tracked source wins over an emulated one,
 * and a hand over a controller, which may lie on the table. Of two sources of one kind the one that moves wins.
 */
export class SourceChoice {
  readonly #movements = new WeakMap<XRInputSource, Movement>();
  #inUse: XRInputSource | null = null;
  #best: SourceReading | null = null;
  #time = 0;

  /** The chosen source of the frame so far; null: none is seen. */
  get best(): SourceReading | null {
    return this.#best;
  }

  /** Starts a frame at this time [s]. */
  begin(time: number): void {
    this.#inUse = this.#best?.source ?? this.#inUse;
    this.#best = null;
    this.#time = time;
  }

  offer(reading: SourceReading): void {
    this.#follow(reading);
    if (!this.#best || this.#wins(reading, this.#best)) this.#best = reading;
  }

  #follow({ source, pose }: SourceReading): void {
    const last = this.#movements.get(source);
    if (!last) {
      const place = { position: copyVec3(pose.position), orientation: copyQuat(pose.orientation) };
      this.#movements.set(source, { ...place, time: Number.NEGATIVE_INFINITY });
      return;
    }
    const moved = distance(last.position, pose.position) > movedBy;
    if (!moved && angleBetween(last.orientation, pose.orientation) <= turnedBy) return;
    copyVec3(pose.position, last.position);
    copyQuat(pose.orientation, last.orientation);
    last.time = this.#time;
  }

  #wins(a: SourceReading, b: SourceReading): boolean {
    if (a.pose.tracking !== b.pose.tracking) return a.pose.tracking === 'tracked';
    if (a.isHand !== b.isHand) return a.isHand;
    return this.#movedAt(a) > this.#movedAt(b);
  }

  /** Returns when a source moved last [s]; now, for the source in use that rests for a moment. */
  #movedAt({ source }: SourceReading): number {
    const time = this.#movements.get(source)?.time ?? Number.NEGATIVE_INFINITY;
    const rests = source === this.#inUse && this.#time - time < keptSeconds;
    return rests ? Number.POSITIVE_INFINITY : time;
  }
}
