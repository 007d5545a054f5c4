import { drawText, textWidth } from 'threepoint-ui/vr';
import { ink } from './board-style';

interface ScoreHeading {
  readonly score: number;
  /** The highest possible score. */
  readonly of: number;
  /** The time that is left [s]. */
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
  drawText(context, 'SCORE', [64, 96], { font: '700 54px', color: ink.soft });
  drawText(context, 'TIME', [664, 96], { font: '700 54px', color: ink.soft });
  drawText(context, String(score), [54, 282], { font: '800 220px', color: ink.text });
  const wide = textWidth(context, String(score), '800 220px');
  drawText(context, `/ ${of}`, [78 + wide, 282], { font: '700 84px', color: ink.soft });
  const late = running && seconds <= lastSeconds;
  if (late) {
    context.fillStyle = ink.warning;
    context.beginPath();
    context.roundRect(640, 116, 330, 190, 22);
    context.fill();
  }
  const color = late ? ink.accentInk : ink.text;
  // Three digits must fit into the space of two.
  const [figures, unit] = seconds >= 100 ? ['800 132px', '700 52px'] : ['800 170px', '700 64px'];
  drawText(context, `${seconds}`, [660, 270], { font: figures, color });
  drawText(context, 's', [672 + textWidth(context, `${seconds}`, figures), 270], { font: unit, color });

  context.strokeStyle = ink.line;
  context.lineWidth = 3;
  context.beginPath();
  context.moveTo(64, ruleAt);
  context.lineTo(width - 64, ruleAt);
  context.stroke();
}
