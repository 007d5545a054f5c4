import { BoxGeometry, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial, PlaneGeometry } from 'three';
import type { ArcheryState } from '../../core/games/archery/archery-state';
import { disposeTree } from '../../scene/dispose-tree';
import { createDrawnTexture } from '../../scene/drawn-texture';
import { merged, painted } from '../../scene/painted-geometry';
import type { Quality } from '../../scene/renderer';
import { boardSize, boardText, paintBoard } from './scoreboard-drawing';
import { woodColor } from './wood';

/** A board on two posts beside the field: score, arrows, time, the last hit; arena frame. */
export interface Scoreboard {
  readonly object: Group;
  /** At a time of the match [s]; draws only what changed. */
  show(state: ArcheryState, time: number): void;
  dispose(): void;
}

const place = { x: -4.9, z: -9 };
const width = 3;
const height = (width * boardSize.height) / boardSize.width;
const middle = 3.3;

export function createScoreboard(quality: Quality): Scoreboard {
  const object = new Group();
  object.name = 'scoreboard';
  // High beside the field, turned to the archer: a glance away from the targets, in front of none.
  object.position.set(place.x, 0, place.z);
  object.rotation.y = Math.atan2(-place.x, -place.z);
  const frame = 0.09;
  const box = (w: number, h: number, d: number, x: number, y: number, z: number, seed: number) =>
    painted(new BoxGeometry(w, h, d).translate(x, y, z), woodColor(seed));
  const wood = new Mesh(
    merged([
      box(width + 2 * frame, frame, 0.09, 0, middle + (height + frame) / 2, 0, 0),
      box(width + 2 * frame, frame, 0.09, 0, middle - (height + frame) / 2, 0, 1),
      box(frame, height, 0.09, -(width + frame) / 2, middle, 0, 2),
      box(frame, height, 0.09, (width + frame) / 2, middle, 0, 3),
      box(width, height, 0.03, 0, middle, -0.02, 1),
      box(0.13, middle + height / 2, 0.1, -width * 0.36, (middle + height / 2) / 2 - 0.02, -0.075, 2),
      box(0.13, middle + height / 2, 0.1, width * 0.36, (middle + height / 2) / 2 - 0.02, -0.075, 0),
      // A little roof.
      painted(
        new BoxGeometry(width + 0.34, 0.03, 0.3).rotateX(0.22).translate(0, middle + height / 2 + 0.13, 0.02),
        '#4f5b63',
      ),
    ]),
    new MeshLambertMaterial({ vertexColors: true }),
  );
  wood.castShadow = wood.receiveShadow = true;
  const { texture, draw } = createDrawnTexture(boardSize.width, boardSize.height, quality);
  const face = new Mesh(new PlaneGeometry(width, height), new MeshBasicMaterial({ map: texture, fog: false }));
  face.position.set(0, middle, 0.004);
  object.add(wood, face);
  let shown = '';
  return {
    object,
    show(state, time) {
      const text = boardText(state, time);
      const key = JSON.stringify(text);
      if (key === shown) return;
      shown = key;
      draw((context) => paintBoard(context, text));
    },
    dispose() {
      object.removeFromParent();
      disposeTree(object);
    },
  };
}
