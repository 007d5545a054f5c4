import type { PanelTarget } from 'threepoint-ui/vr';

/** The size of the sheet [pixels], and how many pixels are a metre. */
export const width = 1200;
export const height = 880;
export const pixelsPerMetre = 1000;
export const margin = 60;
export const inner = width - 2 * margin;

/** A part of the sheet that can be pressed. */
export interface Target extends PanelTarget {
  /** tick: a place on a line that the line draws. */
  readonly kind: 'button' | 'scale' | 'dot' | 'option' | 'key' | 'tick';
  readonly label: string;
  /** The number of a point of a scale, drawn large; absent: none. */
  readonly figure?: string;
  readonly look: 'primary' | 'plain' | 'off' | 'chosen' | 'answered' | 'open' | 'missing' | 'here';
  act(): void;
}
