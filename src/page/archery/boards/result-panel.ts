import { Group } from 'three';
import type { Vec3 } from 'threepoint/core/math/vec3';
import type { ArcheryState } from 'threepoint-games/archery/archery-state';
import { buttonUnder, createSheet, type SheetContent, type SheetSize } from '../../scene/boards/sheet';
import type { Quality } from '../../scene/renderer';
import { paintResult, restartButton, resultSize } from './result-drawing';

const size: SheetSize = { ...resultSize, metres: 1.36 };

/** Whether a point of the panel [m, from its middle] lies on the restart button. */
export const onRestartButton = (x: number, y: number): boolean => buttonUnder([restartButton], size, x, y) !== null;

/** The panel at the end of a round: score, percentage, each arrow, a button for another round; arena frame. */
export function createResultPanel(quality: Quality) {
  const object = new Group();
  object.name = 'result panel';
  object.position.z = -2.1;
  const sheet = createSheet<'restart'>(size, quality);
  object.add(sheet.mesh);
  /** The content for the newest result. The arrows of a finished round are the same objects in every frame. */
  let content: SheetContent<'restart'> | null = null;
  let of: ArcheryState | null = null;

  function contentOf(state: ArcheryState): SheetContent<'restart'> {
    if (content && of?.arrows === state.arrows && of.score === state.score && of.end === state.end) return content;
    of = state;
    content = {
      key: JSON.stringify([state.score, state.end, state.arrows]),
      buttons: [restartButton],
      paint: (context, hovered) => paintResult(context, state, hovered !== null),
    };
    return content;
  }

  return {
    object,
    /** Shows the result of a round that is over; hides itself otherwise. `time`: of the match [s]. */
    show(state: ArcheryState, time: number): void {
      // A little below the eyes, standing or seated.
      object.position.y = state.options.eyeHeight - 0.18;
      sheet.show(state.phase === 'over' ? contentOf(state) : null, time);
    },
    /**
     * Distance along a ray [m, floor frame; unit direction] to the restart button; null: it misses, or there is no
     * panel now.
     */
    restartAt: (origin: Vec3, direction: Vec3): number | null => sheet.buttonAt(origin, direction)?.distance ?? null,
    /** Lights the button while something points at it. */
    setHovered: (on: boolean): void => sheet.setHovered(on ? 'restart' : null),
  };
}
