import { type TrackedPose, trackedOrNull } from '../math/pose';
import type { Side } from '../math/side';

/** How far each button of a hand is pressed, 0 to 1. A controller has no pinch, a bare hand nothing but. */
export interface HandButtons {
  readonly trigger: number;
  readonly grip: number;
  readonly pinch: number;
  /** What they belong to, where that is known. A hand that turns from one into the other lets go of everything. */
  readonly kind?: 'controller' | 'hand';
  /** The number of the device among all of the session; absent where devices are not distinguished. */
  readonly device?: number;
  /** The hand is busy with a gesture of the device's own, such as the one for its menu: for games it is not seen. */
  readonly taken?: boolean;
}

export type Buttons = Readonly<Record<Side, HandButtons>>;

export type Button = 'trigger' | 'grip' | 'pinch';

/** Returns the pose of a hand that plays: null where the device does not see it, or uses it itself. */
export const playingHand = (hand: TrackedPose | null, { taken }: HandButtons): TrackedPose | null =>
  taken ? null : trackedOrNull(hand);

export const allReleased: HandButtons = { trigger: 0, grip: 0, pinch: 0 };
export const nothingPressed: Buttons = { left: allReleased, right: allReleased };

/** Pressed at and above the first, released below the second; between them what it was. */
export const pressedAt = 0.6;
export const releasedBelow = 0.4;

const names: readonly Button[] = ['trigger', 'grip', 'pinch'];
const none: readonly never[] = [];

/** How far a button is pressed, in [0, 1]; what is no number is not pressed. */
export const pressureOf = (buttons: HandButtons, button: Button): number => {
  const value = buttons[button];
  return value > 0 ? Math.min(value, 1) : 0;
};

/** Distinguishes presses from noise by thresholds with hysteresis, separately for each hand. */
export interface ButtonPresses {
  /**
   * The buttons newly pressed in this frame. A hand that is not seen has none; what is down when it is seen (again) for
   * the first time, or when it has become another kind of hand, was not pressed then.
   */
  follow(side: Side, buttons: HandButtons, seen: boolean): readonly Button[];
  /**
   * Whether the last frame's hand was of another kind than the one seen before, or in this very frame became another
   * device, as when two controllers change sides: what it held is not held by this one.
   */
  changedKind(side: Side): boolean;
}

/** What one hand held, and what held it. */
class HandPresses {
  changed = false;
  #kind: HandButtons['kind'] = undefined;
  #device: number | undefined = undefined;
  /** Whether `#down` is known: the hand was seen in the last frame. */
  #known = false;
  readonly #down: Record<Button, boolean> = { trigger: false, grip: false, pinch: false };

  follow(buttons: HandButtons, seen: boolean): readonly Button[] {
    // What an unseen hand is, is as unknown as what it does.
    const kind = seen ? buttons.kind : undefined;
    const device = seen ? buttons.device : undefined;
    const otherKind = kind !== undefined && this.#kind !== undefined && this.#kind !== kind;
    // A controller that was off comes back as another device, to what it held: that alone is no change.
    const otherDevice = device !== undefined && this.#device !== undefined && this.#device !== device;
    this.changed = otherKind || otherDevice;
    this.#kind = kind ?? this.#kind;
    this.#device = device;
    const compared = this.#known && !this.changed;
    this.#known = seen;
    return seen ? this.#press(buttons, compared) : none;
  }

  /** `compared`: what was down before is known. */
  #press(buttons: HandButtons, compared: boolean): readonly Button[] {
    let pressed: Button[] | null = null;
    for (const name of names) {
      const value = pressureOf(buttons, name);
      const before = this.#down[name];
      // A value between the thresholds of a hand that comes into sight may be a press that has not ended.
      const after = value >= pressedAt || (value >= releasedBelow && (before || !compared));
      this.#down[name] = after;
      if (!compared || !after || before) continue;
      pressed ??= [];
      pressed.push(name);
    }
    return pressed ?? none;
  }
}

export function createButtonPresses(): ButtonPresses {
  const hands = { left: new HandPresses(), right: new HandPresses() };
  return {
    changedKind: (side) => hands[side].changed,
    follow: (side, buttons, seen) => hands[side].follow(buttons, seen),
  };
}
