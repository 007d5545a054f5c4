import type { Side } from '../math/side';

/** How far each button of a hand is pressed, 0 to 1. A controller has no pinch, a bare hand nothing but. */
export interface HandButtons {
  readonly trigger: number;
  readonly grip: number;
  readonly pinch: number;
  /** What they belong to, where that is known. A hand that turns from one into the other lets go of everything. */
  readonly kind?: 'controller' | 'hand';
  /** Which device of all that there ever were; absent where nobody tells them apart. */
  readonly device?: number;
}

export type Buttons = Readonly<Record<Side, HandButtons>>;

export type Button = 'trigger' | 'grip' | 'pinch';

export const allReleased: HandButtons = { trigger: 0, grip: 0, pinch: 0 };
export const nothingPressed: Buttons = { left: allReleased, right: allReleased };

/** Pressed at and above the first, released below the second; between them what it was. */
export const pressedAt = 0.6;
export const releasedBelow = 0.4;

const names: readonly Button[] = ['trigger', 'grip', 'pinch'];

/** How far a button is pressed, in [0, 1]; what is no number is not pressed. */
export const pressureOf = (buttons: HandButtons, button: Button): number => {
  const value = buttons[button];
  return value > 0 ? Math.min(value, 1) : 0;
};

/** Tells presses from noise: thresholds with hysteresis, one memory for each hand. */
export interface ButtonPresses {
  /**
   * The buttons newly pressed in this frame. A hand that is not seen has none; what is down when it is seen (again) for the
   * first time, or when it has become another kind of hand, was not pressed then.
   */
  follow(side: Side, buttons: HandButtons, seen: boolean): readonly Button[];
  /**
   * Whether the last frame's hand was of another kind than the one seen before, or in this very frame became another device, as when
   * two controllers change sides: what it held is not held by this one.
   */
  changedKind(side: Side): boolean;
}

export function createButtonPresses(): ButtonPresses {
  const down: Record<Side, Record<Button, boolean> | null> = { left: null, right: null };
  const kinds: Record<Side, HandButtons['kind']> = { left: undefined, right: undefined };
  const devices: Record<Side, number | undefined> = { left: undefined, right: undefined };
  const changed: Record<Side, boolean> = { left: false, right: false };
  return {
    changedKind: (side) => changed[side],
    follow(side, buttons, seen) {
      // While nobody sees a hand, nobody knows what it is either.
      const kind = seen ? buttons.kind : undefined;
      const device = seen ? buttons.device : undefined;
      const otherKind = kind !== undefined && kinds[side] !== undefined && kinds[side] !== kind;
      // A controller that was off comes back as another device, to what it held: that alone is no change.
      const otherDevice = device !== undefined && devices[side] !== undefined && devices[side] !== device;
      changed[side] = otherKind || otherDevice;
      kinds[side] = kind ?? kinds[side];
      devices[side] = device;
      const before = changed[side] ? null : down[side];
      if (!seen) {
        down[side] = null;
        return [];
      }
      const after = { trigger: false, grip: false, pinch: false };
      for (const name of names) {
        const value = pressureOf(buttons, name);
        // A value between the thresholds of a hand that comes into sight may be a press that has not ended.
        after[name] = value >= pressedAt || (value >= releasedBelow && (before === null || before[name]));
      }
      down[side] = after;
      return before ? names.filter((name) => after[name] && !before[name]) : [];
    },
  };
}
