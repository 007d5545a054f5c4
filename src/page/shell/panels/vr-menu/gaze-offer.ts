import { Vector3 } from 'three';
import type { Pointer } from 'threepoint/core';
import type { Pose } from 'threepoint/math';
import { createPanelTouch, createVrPanel, drawText, fillRoundedRect, vrColors } from 'threepoint-ui/vr';

const [width, height] = [720, 200];
/** Before the eyes, and below them there [m]. */
const away = 1.2;
const below = 0.3;

const targets = [{ id: 'gaze', at: [0, 0, width, height] }] as const;

/** A sign before a user whose hands no device tracks: it offers to choose by gaze. */
export class GazeOffer {
  readonly #panel = createVrPanel(width, height, 1100);
  readonly #touch = createPanelTouch(this.#panel, 'offer');
  readonly #ahead = new Vector3();

  constructor() {
    this.#panel.mesh.name = 'gaze offer';
    this.#panel.mesh.visible = false;
    this.#panel.draw((context) => {
      fillRoundedRect(context, [2, 2, width - 4, height - 4], 40, vrColors.glass, vrColors.line);
      const { ink, inkSoft } = vrColors;
      const writing = { align: 'center', baseline: 'middle', maxWidth: width - 80 } as const;
      drawText(context, 'No hand or controller is tracked.', [width / 2, 68], {
        ...writing,
        font: '500 32px',
        color: inkSoft,
      });
      drawText(context, 'Look here to choose by gaze', [width / 2, 130], { ...writing, font: '650 42px', color: ink });
    });
  }

  get object() {
    return this.#panel.mesh;
  }

  hide(): void {
    this.object.visible = false;
  }

  /** Shows the sign before a head (floor frame); returns whether a gaze has accepted it. */
  follow(head: Pose<'floor'>, pointers: readonly Pointer[]): boolean {
    const { object } = this;
    if (!object.visible) {
      const ahead = this.#ahead.set(0, 0, -1).applyQuaternion(object.quaternion.copy(head.orientation)).setY(0);
      object.position.copy(head.position).addScaledVector(ahead.normalize(), away);
      object.position.y -= below;
      object.lookAt(this.#ahead.copy(head.position));
      object.visible = true;
    }
    return this.#touch.follow(pointers, targets).pressed.length > 0;
  }
}
