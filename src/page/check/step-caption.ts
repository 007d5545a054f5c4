import type { Mesh } from 'three';
import { headingOf } from 'threepoint/core';
import { showToEyesOnly } from 'threepoint/internal/three';
import { addScaled, clamp, dampVec3, forward, type Pose, rotate, type Vec3, vec3, wrapAngle } from 'threepoint/math';
import { createVrPanel, drawText, drawTextLines, fillRoundedRect, vrColors } from 'threepoint-ui/vr';
import { disposeTree } from '../scene/dispose-tree';

const [width, height] = [900, 300];
/** The distance of the caption, and how far it lies below the eyes [m]. */
const [away, below] = [1.5, 0.42];
/** The most that the caption stands to the right of where the head looks [rad]: beside the body in the mirror. */
const aside = 0.5;
/** The half-life with which the caption follows the head [s]: a short glance does not move it. */
const halfLife = 0.2;

/**
 * Shows the instruction and the progress of a step in the headset, always in view and beside what the user looks at. A
 * head that turns to it finds it ahead.
 */
export class StepCaption {
  readonly object: Mesh;
  readonly #panel = createVrPanel(width, height, 1000);
  #drawn = '';
  #place: Vec3 | null = null;
  /** The direction in which it stands, as a turn about the vertical axis [rad]. */
  #heading = 0;
  #last = 0;

  constructor() {
    this.object = this.#panel.mesh;
    this.object.name = 'step caption';
    this.object.renderOrder = 20;
    this.object.visible = false;
    showToEyesOnly(this.object);
    const material = [this.object.material].flat()[0];
    if (material) material.depthTest = false;
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
    this.object.visible = eyes !== null;
    if (!eyes) {
      this.#place = null;
      return;
    }
    const ahead = rotate(headingOf(eyes.orientation), forward);
    const looking = Math.atan2(-ahead.x, -ahead.z);
    const toTheRight = this.#place ? wrapAngle(looking - this.#heading) : aside;
    this.#heading = looking - clamp(toTheRight, 0, aside);
    const towards = vec3(-Math.sin(this.#heading), 0, -Math.cos(this.#heading));
    const goal = addScaled(addScaled(eyes.position, towards, away), vec3(0, -1, 0), below);
    this.#place = this.#place ? dampVec3(this.#place, goal, halfLife, Math.max(0, time - this.#last)) : goal;
    this.#last = time;
    const { x, y, z } = this.#place;
    this.object.position.set(x, y, z);
    this.object.lookAt(eyes.position.x, eyes.position.y, eyes.position.z);
  }
}
