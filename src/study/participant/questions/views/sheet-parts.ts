import { vrColors, vrFont } from 'threepoint-ui/canvas-drawing';
import { inner, margin, width } from '../sheet-target';
import type { ScreenEnds } from './card-parts';

/** Draws the texts below the ends of a scale at this height [pixels]. */
export function paintEnds(context: CanvasRenderingContext2D, { low, high }: ScreenEnds, y: number): void {
  context.font = `500 32px ${vrFont}`;
  context.fillStyle = vrColors.inkSoft;
  context.fillText(low, margin, y, inner / 2 - 140);
  context.textAlign = 'right';
  context.fillText(high, width - margin, y, inner / 2 - 140);
  context.textAlign = 'left';
}
