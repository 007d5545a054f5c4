import { ballsLeft } from 'threepoint-games/ball/state-selectors';
import { drawText } from 'threepoint-ui/canvas-drawing';
import { ink, paintGround } from '../../scene/boards/board-style';
import { paintScoreHeading } from '../../scene/boards/score-heading';
import type { DisplayedMatch } from './displayed-match';

export const boardSize = { width: 1024, height: 588 } as const;

/** Score, clock, balls left and the last sentence. */
export function paintBoard(context: CanvasRenderingContext2D, match: DisplayedMatch, line: string): void {
  const { state, seconds } = match;
  const { width, height } = boardSize;
  paintGround(context, width, height);
  paintScoreHeading(context, {
    score: state.score,
    of: state.options.balls,
    seconds,
    running: state.phase === 'running',
  });

  const left = ballsLeft(state);
  drawText(context, 'BALLS', [64, 430], { font: '700 54px', color: ink.soft });
  const total = state.options.balls;
  const step = Math.min(34, 480 / total);
  for (let i = 0; i < total; i++) {
    context.beginPath();
    context.arc(286 + i * step, 411, Math.min(13, step * 0.38), 0, 2 * Math.PI);
    context.fillStyle = i < left ? ink.accent : 'transparent';
    context.strokeStyle = i < left ? ink.accent : ink.line;
    context.lineWidth = 4;
    context.fill();
    context.stroke();
  }
  drawText(context, String(left), [width - 54, 434], { font: '800 64px', color: ink.text, align: 'right' });
  drawText(context, line, [64, 536], { font: '700 60px', color: ink.text, maxWidth: width - 128 });
}
