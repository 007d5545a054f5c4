import { type HandShape, handShapeFromClosing, type MutableHandShape, makeHandShape } from '../../core/body/hand-shape';
import { type Buttons, type HandButtons, pressureOf } from '../../core/input/button-presses';
import type { Side } from '../../core/math/side';

/** Returns the fingers of a hand of which only the buttons are known, such as a bot's or a mouse user's. */
export function handShapeFromButtons(
  buttons: HandButtons,
  target: MutableHandShape = makeHandShape(),
): MutableHandShape {
  const trigger = pressureOf(buttons, 'trigger');
  const grip = pressureOf(buttons, 'grip');
  const closed = Math.max(trigger, grip);
  return handShapeFromClosing(
    { thumb: closed, index: closed, rest: closed, pinch: pressureOf(buttons, 'pinch') },
    target,
  );
}

/** Returns new finger shapes of both hands by their buttons. */
export const fingersFromButtons = ({ left, right }: Buttons): Record<Side, HandShape> => ({
  left: handShapeFromButtons(left),
  right: handShapeFromButtons(right),
});
