import {
  closedHand,
  copyBend,
  fingerBend,
  type HandShape,
  lerpBend,
  type MutableHandShape,
  makeHandShape,
} from '../core/body/hand-shape';
import { smoothingFactor } from '../core/math/damper';

/** WebXR's standard mapping of buttons. */
export const triggerButton = 0;
export const squeezeButton = 1;
/** The buttons under the thumb: touchpad, stick, the two face buttons and the thumb rest. */
const thumbButtons = [2, 3, 4, 5, 6] as const;

/** The half-life [s] of a finger's way to its target: a touch is reported as on or off. */
const halfLife = 0.035;

/** Fingers round a handle of 3.5 cm. */
const heldMiddle = fingerBend(0.82, 0, 1.12, 0.62);
const heldRing = fingerBend(0.88, -0.03, 1.14, 0.62);
const heldLittle = fingerBend(0.92, -0.08, 1.1, 0.6);
/** The index finger on the trigger, and beside it, straight ahead. */
const indexOnTrigger = fingerBend(0.5, 0.04, 0.72, 0.36);
const indexAhead = fingerBend(0.12, 0.06, 0.1, 0.06);
const indexPressed = fingerBend(0.8, 0.03, 1.3, 0.75);
/** The thumb on the controller's face, and stretched away from it. */
const thumbOnFace = fingerBend(0.62, 0.3, 0.34, 0.4);
const thumbUp = fingerBend(0.12, 0.62, -0.05, -0.1);

/** Estimates the fingers of a hand that holds a controller from the buttons that it presses and touches. */
export class ControllerFingers {
  readonly #shape: MutableHandShape = makeHandShape();
  /** The distance of the index finger from the trigger and of the thumb from the face: 0 on it, 1 away. */
  #pointing = 0;
  #thumbAway = 0;
  /** Whether this controller has ever reported a touch without a press. */
  #capacitive = false;
  #lastTime: number | null = null;

  /** Returns the fingers of this frame, overwritten by the next. `time`: [s], on the clock of the frames. */
  read(gamepad: Gamepad | undefined, time: number): HandShape {
    const fraction = this.#lastTime === null ? 1 : smoothingFactor(halfLife, time - this.#lastTime);
    this.#lastTime = time;
    const trigger = gamepad?.buttons[triggerButton];
    const onTrigger = touches(trigger);
    let onFace = false;
    for (const index of thumbButtons) {
      const button = gamepad?.buttons[index];
      onFace ||= touches(button);
      this.#capacitive ||= touchesOnly(button);
    }
    this.#capacitive ||= touchesOnly(trigger);
    // A controller without touch sensors reports no finger: the fingers lie on it.
    this.#pointing += ((this.#capacitive && !onTrigger ? 1 : 0) - this.#pointing) * fraction;
    this.#thumbAway += ((this.#capacitive && !onFace ? 1 : 0) - this.#thumbAway) * fraction;
    this.#bend(pressure(trigger), pressure(gamepad?.buttons[squeezeButton]));
    return this.#shape;
  }

  #bend(trigger: number, squeeze: number): void {
    const { thumb, index, middle, ring, little } = this.#shape;
    lerpBend(heldMiddle, closedHand.middle, squeeze, middle);
    lerpBend(heldRing, closedHand.ring, squeeze, ring);
    lerpBend(heldLittle, closedHand.little, squeeze, little);
    lerpBend(indexPressed, closedHand.index, squeeze, index);
    lerpBend(indexOnTrigger, index, trigger, index);
    lerpBend(index, indexAhead, this.#pointing * (1 - trigger), index);
    copyBend(thumbOnFace, thumb);
    lerpBend(thumb, closedHand.thumb, Math.min(trigger, squeeze), thumb);
    lerpBend(thumb, thumbUp, this.#thumbAway, thumb);
    this.#shape.pinch = 0;
  }
}

const touches = (button: GamepadButton | undefined): boolean => (button?.touched ?? false) || pressure(button) > 0;

const touchesOnly = (button: GamepadButton | undefined): boolean =>
  (button?.touched ?? false) && !button?.pressed && pressure(button) === 0;

const pressure = (button: GamepadButton | undefined): number => {
  const value = button?.value ?? 0;
  return value > 0 ? Math.min(value, 1) : 0;
};
