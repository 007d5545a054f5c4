import { drawText, vrColors } from 'threepoint-ui/vr';
import {
  bottomButton,
  buttonGap,
  fullWidth,
  halfWidth,
  type MenuButton,
  type MenuSheet,
  menuMargin,
  menuWidth,
} from '../../../activity/activity-menu';
import { type GripControl, type GripRow, type GripState, gripHands, gripKinds, handLabels } from '../grip-control';

/** The top of the row of hands, of each group of steps, and the height of a row [pixels]. */
const handsTop = 112;
const groupTops = { Move: 268, Turn: 628 } as const;
const rowHeight = 104;
/** The width of a button of a step, and of the value between two [pixels]. */
const stepWidth = 218;
const valueWidth = fullWidth - 2 * stepWidth;

/** Returns the rows with the top of each [pixels]. */
const placed = (rows: readonly GripRow[]): readonly (readonly [row: GripRow, y: number])[] =>
  rows.map((row, index) => [row, groupTops[row.kind] + (index % 3) * rowHeight]);

function handButtons({ hands }: GripState, grip: GripControl): readonly MenuButton[] {
  const width = (fullWidth - 2 * buttonGap) / 3;
  return gripHands.map((each, index) => ({
    id: each,
    label: handLabels[each],
    at: [menuMargin + index * (width + buttonGap), handsTop, width, rowHeight - buttonGap],
    look: each === hands ? 'chosen' : 'plain',
    act: () => grip.chooseHands(each),
  }));
}

function stepButtons({ rows }: GripState, grip: GripControl): readonly MenuButton[] {
  return placed(rows).flatMap(([row, y]): readonly MenuButton[] => {
    const place = (x: number) => [x, y, stepWidth, rowHeight - buttonGap] as const;
    const { part, less, more, atLeast, atMost } = row;
    const looks = { less: atLeast ? 'off' : 'plain', more: atMost ? 'off' : 'plain' } as const;
    const [left, right] = [menuMargin, menuMargin + stepWidth + valueWidth];
    return [
      { id: `${part} back`, label: less, at: place(left), look: looks.less, act: () => grip.step(row, -1) },
      { id: `${part} on`, label: more, at: place(right), look: looks.more, act: () => grip.step(row, 1) },
    ];
  });
}

/** Returns the sheet of the menu that moves the drawn hands onto the user's own, while they look at them. */
export function gripSheet(state: GripState, grip: GripControl, close: () => void): MenuSheet {
  const closing = bottomButton('close', 'Close', close);
  const [, y, , height] = closing.at;
  return {
    heading: 'Your grip',
    content: state,
    buttons: [
      ...handButtons(state, grip),
      ...stepButtons(state, grip),
      {
        id: 'reset grip',
        label: 'Reset',
        at: [menuMargin, y, halfWidth, height],
        look: 'plain',
        act: () => grip.reset(),
      },
      { ...closing, at: [menuMargin + halfWidth + buttonGap, y, halfWidth, height] },
    ],
    draw(context) {
      const soft = { font: '400 30px', color: vrColors.inkSoft, baseline: 'middle' } as const;
      drawText(context, state.device, [menuWidth - menuMargin - 4, 72], { ...soft, align: 'right', maxWidth: 380 });
      for (const kind of ['Move', 'Turn'] as const)
        drawText(context, gripKinds[kind], [menuMargin + 4, groupTops[kind] - 32], soft);
      for (const [{ value }, top] of placed(state.rows)) {
        const middle = [menuWidth / 2, top + (rowHeight - buttonGap) / 2 + 2] as const;
        const font = '600 28px';
        const style = { font, color: vrColors.ink, align: 'center', baseline: 'middle' } as const;
        drawText(context, value, middle, { ...style, maxWidth: valueWidth - 12 });
      }
    },
  };
}
