import { type TrackedPose, trackedOrNull } from '../math/pose';
import type { Side } from '../math/side';

/** The pressure of each button of a hand, 0 to 1. A controller has no pinch; a bare hand has only a pinch. */
export interface HandButtons {
  readonly trigger: number;
  readonly grip: number;
  readonly pinch: number;
  /** The kind of the input source, if known. A change of kind releases everything that the hand holds. */
  readonly kind?: 'controller' | 'hand';
  /** The number of the device among all of the session; absent where devices are not distinguished. */
  readonly device?: number;
  /** Whether the hand makes a gesture of the device, such as that for its menu: for games it is not tracked. */
  readonly taken?: boolean;
}

export type Buttons = Readonly<Record<Side, HandButtons>>;

export type Button = 'trigger' | 'grip' | 'pinch';

/** Returns the pose of a hand for games; null: it is not tracked, or the device uses it. */
export const playingHand = (hand: TrackedPose | null, { taken }: HandButtons): TrackedPose | null =>
  taken ? null : trackedOrNull(hand);

export const allReleased: HandButtons = { trigger: 0, grip: 0, pinch: 0 };
export const nothingPressed: Buttons = { left: allReleased, right: allReleased };

/** The thresholds of a press with hysteresis: pressed at and above the first, released below the second. */
const pressedAt = 0.6;
export const releasedBelow = 0.4;

const names: readonly Button[] = ['trigger', 'grip', 'pinch'];
const none: readonly never[] = [];

/** Returns a button's pressure in [0, 1]; 0 for NaN. */
export const pressureOf = (buttons: HandButtons, button: Button): number => {
  const value = buttons[button];
  return value > 0 ? Math.min(value, 1) : 0;
};

class HandPresses {
  changed = false;
  #kind: HandButtons['kind'] = undefined;
  #device: number | undefined = undefined;
  /** Whether `#down` is known: the hand was seen in the last frame. */
  #known = false;
  readonly #down: Record<Button, boolean> = { trigger: false, grip: false, pinch: false };

  follow(buttons: HandButtons, seen: boolean): readonly Button[] {
    // The kind of a hand that is not tracked is unknown.
    const kind = seen ? buttons.kind : undefined;
    const device = seen ? buttons.device : undefined;
    const otherKind = kind !== undefined && this.#kind !== undefined && this.#kind !== kind;
    // A controller that was off returns as another device; this alone is no change.
    const otherDevice = device !== undefined && this.#device !== undefined && this.#device !== device;
    this.changed = otherKind || otherDevice;
    this.#kind = kind ?? this.#kind;
    this.#device = device;
    const compared = this.#known && !this.changed;
    this.#known = seen;
    return seen ? this.#press(buttons, compared) : none;
  }

  /** `compared`: whether the state of the previous frame is known. */
  #press(buttons: HandButtons, compared: boolean): readonly Button[] {
    let pressed: Button[] | null = null;
    for (const name of names) {
      const value = pressureOf(buttons, name);
      const before = this.#down[name];
      // A value between the thresholds when a hand becomes tracked may be a press that has not ended.
      const after = value >= pressedAt || (value >= releasedBelow && (before || !compared));
      this.#down[name] = after;
      if (!compared || !after || before) continue;
      pressed ??= [];
      pressed.push(name);
    }
    return pressed ?? none;
  }
}

/** Distinguishes presses from noise by thresholds with hysteresis, separately for each hand. */
export class ButtonPresses {
  readonly #hands = { left: new HandPresses(), right: new HandPresses() };

  /**
   * Returns the buttons that were pressed in this frame. A hand that is not tracked has none. A button that is down
   * when the hand is first tracked, or after a change of kind, does not count.
   */
  follow(side: Side, buttons: HandButtons, seen: boolean): readonly Button[] {
    return this.#hands[side].follow(buttons, seen);
  }

  /**
   * Returns whether the hand's kind changed with the last frame, or its device in this one, as when two controllers
   * swap sides: objects in the hand are then released.
   */
  changedKind(side: Side): boolean {
    return this.#hands[side].changed;
  }
}
