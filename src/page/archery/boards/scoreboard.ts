import { Group } from 'three';
import type { ArcheryState } from 'threepoint-games/archery/archery-state';
import { createWoodenBoard } from '../../scene/boards/wooden-board';
import { createCanvasTexture } from '../../scene/canvas-texture';
import type { Quality } from '../../scene/renderer';
import { boardSize, boardText, paintBoard } from './scoreboard-drawing';

const place = { x: -4.9, z: -9 };
const width = 3;
const height = (width * boardSize.height) / boardSize.width;

/** A board on two posts next to the field: score, arrows, time, the last hit; arena frame. */
export function createScoreboard(quality: Quality) {
  const object = new Group();
  object.name = 'scoreboard';
  // High beside the field, turned to the archer: a glance away from the targets, in front of none.
  object.position.set(place.x, 0, place.z);
  object.rotation.y = Math.atan2(-place.x, -place.z);
  const { texture, draw } = createCanvasTexture(boardSize.width, boardSize.height, quality);
  object.add(createWoodenBoard({ width, height, middle: 3.6 }, texture));
  let shown = '';
  return {
    object,
    /** Updates the board to a match time [s]. Redraws only after a change. */
    show(state: ArcheryState, time: number): void {
      const text = boardText(state, time);
      const key = JSON.stringify(text);
      if (key === shown) return;
      shown = key;
      draw((context) => paintBoard(context, text));
    },
  };
}
