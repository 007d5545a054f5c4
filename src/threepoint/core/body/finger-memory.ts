import { clamp, smoothingFactor } from '../math/damper';
import {
  copyHandShape,
  fingerNames,
  type HandShape,
  isFiniteBend,
  limitBend,
  type MutableHandShape,
  makeHandShape,
  mixBend,
  relaxedHand,
} from './hand-shape';

/** A finger that is not seen keeps its last bend for this long [s], then relaxes with this half-life [s]. */
const heldSeconds = 0.5;
const relaxHalfLife = 0.25;

/** The fingers of one hand as they are shown: finite in every frame, whether they are seen, lost or not finite. */
export class FingerMemory {
  /** Overwritten by the next `follow`. */
  readonly shape: HandShape;
  readonly #shape: MutableHandShape = copyHandShape(relaxedHand, makeHandShape());
  /**
   * For how long each finger has not been seen [s]. Not in the order of a hand's shape, whose objects would box these
   * numbers: see `Vec3`.
   */
  readonly #unseen = {
    little: heldSeconds,
    ring: heldSeconds,
    middle: heldSeconds,
    index: heldSeconds,
    thumb: heldSeconds,
  };

  constructor() {
    this.shape = this.#shape;
  }

  /** What is seen now; null: nothing. A finger with a bend that is not finite counts as not seen. */
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
      mixBend(shown, relaxedHand[name], smoothingFactor(relaxHalfLife, relaxing), shown);
    }
    this.#followPinch(seen, deltaSeconds);
    return this.#shape;
  }

  /** A pinch is as good as the two fingers that make it. */
  #followPinch(seen: HandShape | null, deltaSeconds: number): void {
    const target = this.#shape;
    if (seen && Number.isFinite(seen.pinch)) target.pinch = clamp(seen.pinch, 0, 1);
    else {
      const unseen = Math.max(this.#unseen.thumb, this.#unseen.index);
      target.pinch *= 1 - smoothingFactor(relaxHalfLife, Math.min(deltaSeconds, unseen - heldSeconds));
    }
  }
}
