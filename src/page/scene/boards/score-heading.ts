import { ink, signFont } from './lettering';

export interface ScoreHeading {
  readonly score: number;
  /** The most that can be had. */
  readonly of: number;
  /** Left on the clock. */
  readonly seconds: number;
  readonly running: boolean;
}

/** The clock is highlighted for this time before the bell [s]. */
const lastSeconds = 10;
const width = 1024;
/** The height of the line below the heading [pixels]; the game's own content starts below it. */
const ruleAt = 344;

/** Score and clock over a line: the upper part of a board 1024 pixels wide. */
export function paintScoreHeading(
  context: CanvasRenderingContext2D,
  { score, of, seconds, running }: ScoreHeading,
): void {
  context.textBaseline = 'alphabetic';
  context.textAlign = 'left';
  context.fillStyle = ink.soft;
  context.font = `700 54px ${signFont}`;
  context.fillText('SCORE', 64, 96);
  context.fillText('TIME', 664, 96);
  context.fillStyle = ink.text;
  context.font = `800 220px ${signFont}`;
  context.fillText(String(score), 54, 282);
  const wide = context.measureText(String(score)).width;
  context.fillStyle = ink.soft;
  context.font = `700 84px ${signFont}`;
  context.fillText(`/ ${of}`, 78 + wide, 282);
  const late = running && seconds <= lastSeconds;
  if (late) {
    context.fillStyle = ink.warning;
    context.beginPath();
    context.roundRect(640, 116, 330, 190, 22);
    context.fill();
  }
  context.fillStyle = late ? ink.accentInk : ink.text;
  // Three digits must fit into the space of two.
  const long = seconds >= 100;
  context.font = `800 ${long ? 132 : 170}px ${signFont}`;
  context.fillText(`${seconds}`, 660, 270);
  const clock = context.measureText(`${seconds}`).width;
  context.font = `700 ${long ? 52 : 64}px ${signFont}`;
  context.fillText('s', 672 + clock, 270);

  context.strokeStyle = ink.line;
  context.lineWidth = 3;
  context.beginPath();
  context.moveTo(64, ruleAt);
  context.lineTo(width - 64, ruleAt);
  context.stroke();
}
