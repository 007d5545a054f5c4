import type { Side } from './bow-hand';

/** How far each button of a hand is pressed, 0 to 1. A controller has no pinch, a bare hand nothing but. */
export interface HandButtons {
  readonly trigger: number;
  readonly grip: number;
  readonly pinch: number;
}

export type Buttons = Readonly<Record<Side, HandButtons>>;

export type Button = keyof HandButtons;

export const allReleased: HandButtons = { trigger: 0, grip: 0, pinch: 0 };

/** Pressed at and above the first, released below the second; between them what it was. */
export const pressedAt = 0.6;
export const releasedBelow = 0.4;

const names: readonly Button[] = ['trigger', 'grip', 'pinch'];

/** Tells presses from noise: thresholds with hysteresis, one memory for each hand. */
export interface ButtonPresses {
  /**
   * The buttons newly pressed in this frame. A hand that is not seen has none; what is down when it is seen (again) for the
   * first time was not pressed then.
   */
  follow(side: Side, buttons: HandButtons, seen: boolean): readonly Button[];
}

export function createButtonPresses(): ButtonPresses {
  const down: Record<Side, Record<Button, boolean> | null> = { left: null, right: null };
  return {
    follow(side, buttons, seen) {
      const before = down[side];
      if (!seen) {
        down[side] = null;
        return [];
      }
      const after = { trigger: false, grip: false, pinch: false };
      for (const name of names) {
        const value = buttons[name];
        // A value between the thresholds of a hand that comes into sight may be a press that has not ended.
        after[name] = value >= pressedAt || (value >= releasedBelow && (before === null || before[name]));
      }
      down[side] = after;
      return before ? names.filter((name) => after[name] && !before[name]) : [];
    },
  };
}
