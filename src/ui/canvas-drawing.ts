/** The colours of the dark scheme (styles/tokens.css), for what is drawn in the headset. */
export const vrColors = {
  ink: '#f1f4f9',
  inkSoft: '#b6c1d3',
  glass: 'rgba(18, 24, 35, 0.92)',
  line: 'rgba(190, 208, 238, 0.22)',
  lift: 'rgba(190, 208, 238, 0.12)',
  liftMore: 'rgba(190, 208, 238, 0.28)',
  accent: '#ffb468',
  accentInk: '#2a1703',
} as const;

export const vrFont = 'Inter, "Segoe UI", system-ui, Roboto, sans-serif';

/** How a text is written on a canvas. */
export interface TextStyle {
  /** Weight and size. */
  readonly font: string;
  readonly color: string;
  /** Default: left. */
  readonly align?: CanvasTextAlign;
  /** Default: alphabetic. */
  readonly baseline?: CanvasTextBaseline;
  /** The greatest width [pixels]; a longer text is compressed. */
  readonly maxWidth?: number;
}

/** Writes a text at a place of a canvas [pixels]. */
export function drawText(
  context: CanvasRenderingContext2D,
  text: string,
  [x, y]: readonly [number, number],
  { font, color, align = 'left', baseline = 'alphabetic', maxWidth }: TextStyle,
): void {
  context.font = `${font} ${vrFont}`;
  context.fillStyle = color;
  context.textAlign = align;
  context.textBaseline = baseline;
  context.fillText(text, x, y, maxWidth);
}

/**
 * Writes a text in lines of at most `width` pixels, broken at spaces, the first at (x, y) and each `step` below the one
 * before. `maxLines`: further ones are left out.
 */
export function drawTextLines(
  context: CanvasRenderingContext2D,
  text: string,
  [x, y, width]: readonly [number, number, number],
  step: number,
  writing: TextStyle,
  maxLines?: number,
): void {
  context.font = `${writing.font} ${vrFont}`;
  const lines = wrapText(context, text, width).slice(0, maxLines);
  for (const [index, line] of lines.entries()) drawText(context, line, [x, y + index * step], writing);
}

/** Returns the width of a text in a weight and size [pixels]. */
export function textWidth(context: CanvasRenderingContext2D, text: string, font: string): number {
  context.font = `${font} ${vrFont}`;
  return context.measureText(text).width;
}

export function fillRoundedRect(
  context: CanvasRenderingContext2D,
  [x, y, width, height]: readonly [number, number, number, number],
  radius: number,
  fill: string,
  stroke?: string,
): void {
  context.beginPath();
  context.roundRect(x, y, width, height, radius);
  context.fillStyle = fill;
  context.fill();
  if (stroke) {
    context.lineWidth = 2;
    context.strokeStyle = stroke;
    context.stroke();
  }
}

/** Lines of at most `most` pixels, broken at spaces. */
export function wrapText(context: CanvasRenderingContext2D, text: string, most: number): string[] {
  const lines: string[] = [];
  let line = '';
  for (const word of text.split(' ')) {
    const longer = line ? `${line} ${word}` : word;
    if (line && context.measureText(longer).width > most) {
      lines.push(line);
      line = word;
    } else line = longer;
  }
  return [...lines, line];
}
