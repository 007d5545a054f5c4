import type { ComponentChildren, InputHTMLAttributes } from 'preact';
import { vrColors, vrFont } from 'threepoint-ui/vr';
import { inner, margin, width } from '../sheet-target';

export interface ScreenPoint<Value> {
  readonly value: Value;
  /** Its label; empty: the value alone is shown. */
  readonly label: string;
}

export interface ScreenEnds {
  readonly low: string;
  readonly high: string;
}

/** A scale with more points shows no numbers, on the card as on the sheet, as on the paper form of NASA-TLX. */
export const maxNumberedPoints = 11;

/** The texts below the ends of a scale, on the card. */
export const Ends = ({ low, high }: ScreenEnds) => (
  <div class="ends" aria-hidden>
    <span>{low}</span>
    <span>{high}</span>
  </div>
);

/** Draws the texts below the ends of a scale on the sheet, at this height [pixels]. */
export function paintEnds(context: CanvasRenderingContext2D, { low, high }: ScreenEnds, y: number): void {
  context.font = `500 32px ${vrFont}`;
  context.fillStyle = vrColors.inkSoft;
  context.fillText(low, margin, y, inner / 2 - 140);
  context.textAlign = 'right';
  context.fillText(high, width - margin, y, inner / 2 - 140);
  context.textAlign = 'left';
}

interface RadioProps extends Pick<InputHTMLAttributes, 'name' | 'value' | 'checked' | 'onChange' | 'aria-label'> {
  readonly children: ComponentChildren;
}

/** A point of which one in its group can be chosen, on the card. */
export const Radio = ({ children, ...input }: RadioProps) => (
  <label class="choice">
    <input type="radio" {...input} />
    {children}
  </label>
);
