import { Group } from 'three';
import { type BallState, ballsLeft } from 'threepoint-games/ball';
import { drawText } from 'threepoint-ui/vr';
import type { DisplayedMatch } from '../../people/view/displayed-match';
import { ink, paintGround } from '../../scene/boards/board-style';
import { paintScoreHeading } from '../../scene/boards/score-heading';
import { createWoodenBoard } from '../../scene/boards/wooden-board';
import { createCanvasTexture } from '../../scene/canvas-texture';
import type { Quality } from '../../scene/renderer';
import { court } from '../court/court-plan';

const boardSize = { width: 1024, height: 588 } as const;

/** Paints score, clock, balls left and the last sentence. */
function paintBoard(context: CanvasRenderingContext2D, match: DisplayedMatch<BallState>, line: string): void {
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

/**
 * Creates two equal boards: one behind the holder, for the throwers, and one behind the throwers, for the holder;
 * arena frame.
 */
export function createBoards(quality: Quality) {
  const object = new Group();
  object.name = 'boards';
  const { texture, draw } = createCanvasTexture(boardSize.width, boardSize.height, quality);
  for (const { z, turned, width, middle } of court.boards) {
    const height = (width * boardSize.height) / boardSize.width;
    const board = createWoodenBoard({ width, height, middle }, texture);
    board.position.z = z;
    board.rotation.y = turned;
    object.add(board);
  }
  let shown = '';
  return {
    object,
    show(match: DisplayedMatch<BallState>, line: string): void {
      const { state, seconds } = match;
      const left = state.balls.map((location) => location.on + (location.on === 'air' && location.missed ? 'x' : ''));
      const key = JSON.stringify([state.score, seconds, state.phase, state.end, state.options, left, line]);
      if (key === shown) return;
      shown = key;
      draw((context) => paintBoard(context, match, line));
    },
  };
}

export type Boards = ReturnType<typeof createBoards>;
