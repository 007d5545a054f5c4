import { drawText, vrColors } from 'threepoint-ui/vr';
import {
  bottomButton,
  inColumns,
  type MenuEntry,
  type MenuSheet,
  menuMargin,
  menuWidth,
} from '../../../activity/activity-menu';

export interface ComfortState {
  /** The user can be turned and raised: not in a room that is seen. */
  readonly moves: boolean;
  /** How much higher the user stands than the device reports [m]. */
  readonly raised: number;
  /** The user sits and is shown at standing height. */
  readonly seated: boolean;
  readonly gaze: boolean;
  readonly sound: boolean;
  readonly largerText: boolean;
}

export interface ComfortActions {
  /** To the left for 1. */
  turn(direction: -1 | 1): void;
  setSeated(on: boolean): void;
  /** Raises the user by this much more [m]. */
  raiseBy(metres: number): void;
  setGaze(on: boolean): void;
  setSound(on: boolean): void;
  setLargerText(on: boolean): void;
  close(): void;
}

/** One step of the height [m]. */
const heightStep = 0.05;
const top = 150;
const rowHeight = 128;

const onOff = (on: boolean): string => (on ? 'on' : 'off');

function comfortEntries(state: ComfortState, actions: ComfortActions): readonly MenuEntry[] {
  const { moves, seated, gaze, sound, largerText } = state;
  const moving: readonly MenuEntry[] = [
    { id: 'turn-left', label: 'Turn left', act: () => actions.turn(1) },
    { id: 'turn-right', label: 'Turn right', act: () => actions.turn(-1) },
    { id: 'lower', label: 'Lower me', act: () => actions.raiseBy(-heightStep) },
    { id: 'raise', label: 'Raise me', act: () => actions.raiseBy(heightStep) },
    { id: 'seated', label: seated ? 'I stand' : 'I sit', act: () => actions.setSeated(!seated) },
  ];
  return [
    ...(moves ? moving : []),
    { id: 'gaze', label: `Gaze: ${onOff(gaze)}`, act: () => actions.setGaze(!gaze) },
    { id: 'sound', label: `Sound: ${onOff(sound)}`, act: () => actions.setSound(!sound) },
    { id: 'text', label: `Larger text: ${onOff(largerText)}`, act: () => actions.setLargerText(!largerText) },
  ];
}

/** Returns the sheet of the menu for turns, height, gaze and sound. */
export function comfortSheet(state: ComfortState, actions: ComfortActions): MenuSheet {
  const centimetres = Math.round(100 * state.raised);
  const height = centimetres === 0 ? 'as tracked' : `${centimetres > 0 ? '+' : '−'}${Math.abs(centimetres)} cm`;
  return {
    heading: 'Comfort',
    content: state,
    buttons: [
      ...inColumns(comfortEntries(state, actions), top, rowHeight),
      bottomButton('close', 'Close', () => actions.close()),
    ],
    draw(context) {
      if (!state.moves) return;
      const writing = { font: '400 30px', color: vrColors.inkSoft, align: 'right', baseline: 'middle' } as const;
      drawText(context, `Height: ${height}`, [menuWidth - menuMargin - 4, 72], writing);
    },
  };
}
