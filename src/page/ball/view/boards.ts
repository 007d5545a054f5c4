import { Group } from 'three';
import { createWoodenBoard } from '../../scene/boards/wooden-board';
import { createCanvasTexture } from '../../scene/canvas-texture';
import type { Quality } from '../../scene/renderer';
import { court } from '../court/court-plan';
import { boardSize, paintBoard } from './board-drawing';
import type { DisplayedMatch } from './displayed-match';

/**
 * Two equal boards: one behind the holder, for the throwers, and one behind the throwers, for the holder; arena frame.
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
    show(match: DisplayedMatch, line: string): void {
      const { state, seconds } = match;
      const left = state.balls.map((place) => place.on + (place.on === 'air' && place.missed ? 'x' : ''));
      const key = JSON.stringify([state.score, seconds, state.phase, state.end, state.options, left, line]);
      if (key === shown) return;
      shown = key;
      draw((context) => paintBoard(context, match, line));
    },
  };
}

export type Boards = ReturnType<typeof createBoards>;
