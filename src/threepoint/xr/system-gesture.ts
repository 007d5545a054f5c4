import { releasedBelow } from '../core/input/button-presses';
import type { Pose } from '../core/math/pose';
import { rotate } from '../core/math/quat';
import { dot, down, normalise, subtract, vec3 } from '../core/math/vec3';

/** A palm faces the eyes when their direction is within 35° of its normal. */
const facing = Math.cos((35 * Math.PI) / 180);

interface SeenHand {
  readonly wrist: Pose<'floor'>;
  /** 0 to 1; NaN: the fingers are not seen. */
  readonly pinch: number;
  /** Whether the browser reports a pointing direction for the hand. */
  readonly hasRay: boolean;
  /** Whether the browser reports the pinch as the device's menu button. */
  readonly menu: boolean;
}

/**
 * Decides when a bare hand belongs to the device. WebXR has no signal for it (webxr-hand-input 117): browsers remove
 * the ray of such a hand, report a menu button, or report nothing. Hence a pinch that begins with the palm towards the
 * eyes, which opens the menus of Quest and Vision Pro, belongs to the device until it is released.
 */
export class SystemGesture {
  #hadRay = false;
  #pinching = false;
  #taken = false;
  readonly #palm = vec3(0, 0, 0);
  readonly #toEyes = vec3(0, 0, 0);

  /** Returns whether the hand belongs to the device in this frame; null head: not seen. */
  follow({ wrist, pinch, hasRay, menu }: SeenHand, head: Pose<'floor'> | null): boolean {
    this.#hadRay ||= hasRay;
    const before = this.#pinching;
    if (!Number.isNaN(pinch)) this.#pinching = pinch >= releasedBelow;
    if (!this.#pinching) this.#taken = false;
    else if (menu || (!before && head !== null && this.#faces(wrist, head))) this.#taken = true;
    return this.#taken || menu || (this.#hadRay && !hasRay);
  }

  #faces(wrist: Pose<'floor'>, head: Pose<'floor'>): boolean {
    const toEyes = normalise(subtract(head.position, wrist.position, this.#toEyes), undefined, this.#toEyes);
    return dot(rotate(wrist.orientation, down, this.#palm), toEyes) > facing;
  }
}
