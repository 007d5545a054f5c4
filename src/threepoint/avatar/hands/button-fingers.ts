import { type HandShape, type MutableHandShape, makeHandShape, shapeOfClosing } from '../../core/body/hand-shape';
import { type Buttons, type HandButtons, pressureOf } from '../../core/input/button-presses';
import type { Side } from '../../core/math/side';

/** Returns the fingers of a hand whose buttons alone are known: a built-in player's, or a mouse's. */
export function shapeOfButtons(buttons: HandButtons, target: MutableHandShape = makeHandShape()): MutableHandShape {
  const trigger = pressureOf(buttons, 'trigger');
  const grip = pressureOf(buttons, 'grip');
  const closed = Math.max(trigger, grip);
  return shapeOfClosing({ thumb: closed, index: closed, rest: closed, pinch: pressureOf(buttons, 'pinch') }, target);
}

/** Returns new finger shapes of both hands by their buttons. */
export const fingersOfButtons = ({ left, right }: Buttons): Record<Side, HandShape> => ({
  left: shapeOfButtons(left),
  right: shapeOfButtons(right),
});
