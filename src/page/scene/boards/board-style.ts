export const ink = {
  text: '#f4f7fb',
  soft: '#b9c6d6',
  board: '#17222c',
  boardLift: '#24333f',
  line: 'rgba(200, 216, 236, 0.24)',
  /** Light on dark and dark on light alike: what the eye should find first. */
  accent: '#ffc861',
  accentLift: '#ffe0a0',
  accentInk: '#2a1a02',
  good: '#8fe3c0',
  warning: '#ffab5c',
} as const;

/** Paints the dark background of a board. */
export function paintGround(context: CanvasRenderingContext2D, width: number, height: number): void {
  const gradient = context.createLinearGradient(0, 0, 0, height);
  gradient.addColorStop(0, ink.boardLift);
  gradient.addColorStop(1, ink.board);
  context.fillStyle = gradient;
  context.fillRect(0, 0, width, height);
}

/** Paints the ground with round corners and an edge, for a free-hanging sheet. */
export function paintCard(context: CanvasRenderingContext2D, width: number, height: number): void {
  context.save();
  context.beginPath();
  context.roundRect(4, 4, width - 8, height - 8, 44);
  context.clip();
  paintGround(context, width, height);
  context.restore();
  context.strokeStyle = ink.line;
  context.lineWidth = 5;
  context.beginPath();
  context.roundRect(4, 4, width - 8, height - 8, 44);
  context.stroke();
}
