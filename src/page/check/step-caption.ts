import { headingOf } from 'threepoint/core';
import { clamp, forward, type Pose, rotate, vec3, wrapAngle } from 'threepoint/math';
import {
  createFloatingPanel,
  createVrPanel,
  drawText,
  drawTextLines,
  fillRoundedRect,
  vrColors,
} from 'threepoint-ui/vr';
import { disposeTree } from '../scene/dispose-tree';

const [width, height] = [900, 300];
/** The most that the caption stands to the right of where the head looks [rad]: beside the body in the mirror. */
const aside = 0.5;

/**
 * Shows the instruction and the progress of a step in the headset, always in view and beside what the user looks at. A
 * head that turns to it finds it ahead.
 */
export class StepCaption {
  readonly #panel = createVrPanel(width, height, 1000);
  readonly #floating = createFloatingPanel(this.#panel, { away: 1.5, below: 0.42, halfLife: 0.2 });
  #drawn = '';
  /** The direction in which it stands, as a turn about the vertical axis [rad]. */
  #heading: number | null = null;

  constructor() {
    this.object.name = 'step caption';
  }

  get object() {
    return this.#panel.mesh;
  }

  /** Draws the sentence, and a line such as “3 of 7 · 12 s” below it. Redraws only what changed. */
  write(sentence: string, progress: string, share: number): void {
    const drawn = `${sentence}\n${progress}`;
    if (drawn === this.#drawn) return;
    this.#drawn = drawn;
    this.#panel.draw((context) => {
      const { glass, line, ink, inkSoft, liftMore, accent } = vrColors;
      fillRoundedRect(context, [4, 4, width - 8, height - 8], 32, glass, line);
      const writing = { font: '600 46px', color: ink, baseline: 'middle' } as const;
      drawTextLines(context, sentence, [48, 66, width - 96], 56, writing);
      drawText(context, progress, [48, height - 66], { ...writing, font: '500 34px', color: inkSoft });
      fillRoundedRect(context, [48, height - 34, width - 96, 10], 5, liftMore);
      fillRoundedRect(context, [48, height - 34, Math.max(10, (width - 96) * share), 10], 5, accent);
    });
  }

  /** Removes the caption from its scene and from the graphics device. */
  dispose(): void {
    this.object.removeFromParent();
    disposeTree(this.object);
  }

  /** Places the caption before these eyes, floor frame; null: no person wears the headset. */
  show(time: number, eyes: Pose<'floor'> | null): void {
    if (!eyes) {
      this.#floating.hide();
      this.#heading = null;
      return;
    }
    const ahead = rotate(headingOf(eyes.orientation), forward);
    const looking = Math.atan2(-ahead.x, -ahead.z);
    const toTheRight = this.#heading === null ? aside : wrapAngle(looking - this.#heading);
    this.#heading = looking - clamp(toTheRight, 0, aside);
    this.#floating.show(time, eyes.position, vec3(-Math.sin(this.#heading), 0, -Math.cos(this.#heading)));
  }
}
