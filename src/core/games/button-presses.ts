import type { Side } from './fist';

/** How far each button of a hand is pressed, 0 to 1. A controller has no pinch, a bare hand nothing but. */
export interface HandButtons {
  readonly trigger: number;
  readonly grip: number;
  readonly pinch: number;
  /** What they belong to, where that is known. A hand that turns from one into the other lets go of everything. */
  readonly kind?: 'controller' | 'hand';
}

export type Buttons = Readonly<Record<Side, HandButtons>>;

export type Button = 'trigger' | 'grip' | 'pinch';

export const allReleased: HandButtons = { trigger: 0, grip: 0, pinch: 0 };

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
  /** Whether the last frame's hand was of another kind than the frame's before. */
  changedKind(side: Side): boolean;
}

export function createButtonPresses(): ButtonPresses {
  const down: Record<Side, Record<Button, boolean> | null> = { left: null, right: null };
  const kinds: Record<Side, HandButtons['kind']> = { left: undefined, right: undefined };
  const changed: Record<Side, boolean> = { left: false, right: false };
  return {
    changedKind: (side) => changed[side],
    follow(side, buttons, seen) {
      // While nobody sees a hand, nobody knows what it is either.
      const kind = seen ? buttons.kind : undefined;
      changed[side] = kind !== undefined && kinds[side] !== undefined && kinds[side] !== kind;
      kinds[side] = kind ?? kinds[side];
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
