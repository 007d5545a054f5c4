import { clamp, smoothingFactor } from '../math/damper';
import {
  copyHandShape,
  fingerNames,
  type HandShape,
  isFiniteBend,
  lerpBend,
  limitBend,
  type MutableHandShape,
  makeHandShape,
  relaxedHand,
} from './hand-shape';

/** The time for which a finger that is not tracked keeps its bend [s], and the half-life of its relaxation [s]. */
const heldSeconds = 0.5;
const relaxHalfLife = 0.25;

/** Keeps the fingers of one hand finite in every frame, whether they are tracked, lost or not finite. */
export class FingerMemory {
  readonly #shape: MutableHandShape = copyHandShape(relaxedHand, makeHandShape());
  /** Overwritten by the next `follow`. */
  readonly shape: HandShape = this.#shape;
  /**
   * The time since each finger was tracked [s]. The order differs from a hand's shape, whose objects would box these
   * numbers: see `Vec3`.
   */
  readonly #unseen = {
    little: heldSeconds,
    ring: heldSeconds,
    middle: heldSeconds,
    index: heldSeconds,
    thumb: heldSeconds,
  };

  /**
   * Updates the shape with the tracked one (null: not tracked). A finger with a bend that is not finite counts as not
   * tracked.
   */
  follow(seen: HandShape | null, deltaSeconds: number): HandShape {
    for (let i = 0; i < fingerNames.length; i++) {
      const name = fingerNames[i]!;
      const shown = this.#shape[name];
      if (seen && isFiniteBend(seen[name])) {
        limitBend(seen[name], shown);
        this.#unseen[name] = 0;
        continue;
      }
      const before = this.#unseen[name];
      this.#unseen[name] = before + deltaSeconds;
      const relaxing = Math.min(deltaSeconds, before + deltaSeconds - heldSeconds);
      lerpBend(shown, relaxedHand[name], smoothingFactor(relaxHalfLife, relaxing), shown);
    }
    this.#followPinch(seen, deltaSeconds);
    return this.#shape;
  }

  /** A pinch is tracked if both of its fingers are. */
  #followPinch(seen: HandShape | null, deltaSeconds: number): void {
    const target = this.#shape;
    if (seen && Number.isFinite(seen.pinch)) target.pinch = clamp(seen.pinch, 0, 1);
    else {
      const unseen = Math.max(this.#unseen.thumb, this.#unseen.index);
      target.pinch *= 1 - smoothingFactor(relaxHalfLife, Math.min(deltaSeconds, unseen - heldSeconds));
    }
  }
}
