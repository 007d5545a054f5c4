import type { PanelTarget } from 'threepoint-ui/vr-touch';
import type { ScreenButton } from './study-screen';

/** The sheet [pixels], and how many of them are a metre. */
export const width = 1200;
export const height = 880;
export const pixelsPerMetre = 1000;
export const margin = 60;
export const inner = width - 2 * margin;

/** What can be pressed on the sheet, and how it looks. */
export interface Target extends PanelTarget {
  /** tick: a place on a line, which draws itself. */
  readonly kind: 'button' | 'scale' | 'dot' | 'option' | 'key' | 'tick';
  readonly label: string;
  /** Of a point of a scale: its number, large; absent: none. */
  readonly figure?: string;
  readonly look: ScreenButton['look'] | 'chosen' | 'answered' | 'open' | 'missing' | 'here';
  act(): void;
}
