import { Group, Matrix4, Mesh, MeshBasicMaterial, PlaneGeometry, Vector3 } from 'three';
import type { ArcheryState } from '../../core/games/archery/archery-state';
import { disposeTree } from '../../scene/dispose-tree';
import { createDrawnTexture } from '../../scene/drawn-texture';
import type { Quality } from '../../scene/renderer';
import { paintResult, restartButton, resultSize } from './scoreboard-drawing';

interface Point {
  readonly x: number;
  readonly y: number;
  readonly z: number;
}

/** The panel at the end of a round: score, percentage, each arrow, a button for another round; arena frame. */
export interface ResultPanel {
  readonly object: Group;
  /** Shows the result of a round that is over; hides itself otherwise. */
  show(state: ArcheryState): void;
  /** Distance along a ray [m, floor frame; unit direction] to the restart button; null: it misses, or there is no panel now. */
  restartAt(origin: Point, direction: Point): number | null;
  /** Lights the button while something points at it. */
  setHovered(on: boolean): void;
  dispose(): void;
}

const width = 1.36;
const height = (width * resultSize.height) / resultSize.width;

/** Whether a point of the panel [m, from its middle] lies on the restart button. */
export function onRestartButton(x: number, y: number): boolean {
  const pixelsPerMetre = resultSize.width / width;
  const px = resultSize.width / 2 + x * pixelsPerMetre - restartButton.x;
  const py = resultSize.height / 2 - y * pixelsPerMetre - restartButton.y;
  return px >= 0 && px <= restartButton.width && py >= 0 && py <= restartButton.height;
}

export function createResultPanel(quality: Quality): ResultPanel {
  const object = new Group();
  object.name = 'result panel';
  object.position.set(0, 1.42, -2.1);
  const { texture, draw } = createDrawnTexture(resultSize.width, resultSize.height, quality);
  const sheet = new Mesh(
    new PlaneGeometry(width, height),
    new MeshBasicMaterial({ map: texture, transparent: true, fog: false, toneMapped: false }),
  );
  sheet.renderOrder = 5;
  object.add(sheet);
  object.visible = false;
  let shown: ArcheryState | null = null;
  let hovered = false;
  let drawn = '';

  function redraw(): void {
    if (!shown) return;
    const state = shown;
    const key = JSON.stringify([state.score, state.end, state.arrows, hovered]);
    if (key === drawn) return;
    drawn = key;
    draw((context) => paintResult(context, state, hovered));
  }

  const inverse = new Matrix4();
  const from = new Vector3();
  const along = new Vector3();
  return {
    object,
    show(state) {
      shown = state.phase === 'over' ? state : null;
      object.visible = shown !== null;
      redraw();
    },
    restartAt(origin, direction) {
      if (!shown) return null;
      sheet.updateWorldMatrix(true, false);
      inverse.copy(sheet.matrixWorld).invert();
      from.copy(origin).applyMatrix4(inverse);
      along.copy(direction).transformDirection(inverse);
      if (from.z <= 0 || along.z >= 0) return null;
      const distance = -from.z / along.z;
      return onRestartButton(from.x + along.x * distance, from.y + along.y * distance) ? distance : null;
    },
    setHovered(on) {
      hovered = on;
      redraw();
    },
    dispose() {
      object.removeFromParent();
      disposeTree(object);
    },
  };
}
