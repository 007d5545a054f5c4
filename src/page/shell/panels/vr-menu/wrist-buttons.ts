import { Group, Matrix4, Quaternion, Vector3 } from 'three';
import { type Pointer, sideSign, type TrackingFrame } from 'threepoint/core';
import { type Side, sides } from 'threepoint/math';
import { createPanelTouch, createVrPanel, drawText, fillRoundedRect, vrColors } from 'threepoint-ui/vr';

const [width, height] = [240, 120];
/**
 * The button lies this far above the wrist, and this far from it to the knuckles [m]: there a bent wrist does not hide
 * it.
 */
const above = 0.045;
const toKnuckles = 0.02;
/** The button shows while the back of the wrist is within 55° of facing the eyes, and within 32° of the gaze. */
const turnedToEyes = Math.cos((55 * Math.PI) / 180);
const lookedAt = Math.cos((32 * Math.PI) / 180);

const targets = [{ id: 'menu', at: [0, 0, width, height] }] as const;

/** A ray of a hand or a controller may cross a wrist at any time; only a finger tip that touches it means it. */
const aimsByEyes = ({ source }: Pointer): boolean => source === 'gaze' || source === 'transient';

function createWristButton(side: Side) {
  const panel = createVrPanel(width, height, 3000);
  panel.mesh.name = `${side} wrist button`;
  panel.mesh.visible = false;
  panel.draw((context) => {
    fillRoundedRect(context, [4, 4, width - 8, height - 8], 40, vrColors.glass, vrColors.accent);
    const writing = { font: '650 52px', color: vrColors.ink, align: 'center', baseline: 'middle' } as const;
    drawText(context, 'Menu', [width / 2, height / 2 + 3], writing);
  });
  return { side, panel, touch: createPanelTouch(panel, 'wrist', aimsByEyes) };
}

/** A button on the back of each wrist that brings the menu: touched by the other hand, looked at, or pinched at. */
export class WristButtons {
  readonly object = new Group();
  readonly #buttons = sides.map(createWristButton);
  readonly #axes = { along: new Vector3(), back: new Vector3(), across: new Vector3() };
  readonly #toEyes = new Vector3();
  readonly #turned = new Matrix4();
  readonly #head = new Quaternion();
  /** The pointers that may press a button in this frame. */
  readonly #others: Pointer[] = [];

  constructor() {
    this.object.add(...this.#buttons.map(({ panel }) => panel.mesh));
  }

  hide(): void {
    for (const { panel } of this.#buttons) panel.mesh.visible = false;
  }

  /** Follows the wrists of a frame (floor frame); returns whether a button was pressed. */
  follow(frame: TrackingFrame, pointers: readonly Pointer[]): boolean {
    const others = this.#others;
    let pressed = false;
    for (const each of this.#buttons) {
      const { side, panel, touch } = each;
      panel.mesh.visible = this.#place(each, frame);
      if (!panel.mesh.visible) continue;
      // A hand that holds something is not poking, and no hand reaches its own wrist.
      others.length = 0;
      for (const pointer of pointers) {
        if (pointer.side !== side && (!pointer.held || aimsByEyes(pointer))) others.push(pointer);
      }
      if (touch.follow(others, targets).pressed.length > 0) pressed = true;
    }
    return pressed;
  }

  /** Places a button on its wrist; returns whether it can be seen there. */
  #place({ side, panel: { mesh } }: ReturnType<typeof createWristButton>, frame: TrackingFrame): boolean {
    const wrist = side === 'left' ? frame.leftHand : frame.rightHand;
    if (wrist?.tracking !== 'tracked' || frame.suspended) return false;
    const { along, back, across } = this.#axes;
    mesh.quaternion.copy(wrist.orientation);
    back.set(0, 1, 0).applyQuaternion(mesh.quaternion);
    // The text runs along the forearm, as on a watch that is held before the chest: to the fingers at the left hand.
    along.set(0, 0, sideSign(side) > 0 ? 1 : -1).applyQuaternion(mesh.quaternion);
    across.crossVectors(back, along);
    mesh.quaternion.setFromRotationMatrix(this.#turned.makeBasis(along, across, back));
    const outward = side === 'left' ? toKnuckles : -toKnuckles;
    mesh.position.copy(wrist.position).addScaledVector(back, above).addScaledVector(along, outward);
    const toEyes = this.#toEyes.copy(frame.head.position).sub(mesh.position).normalize();
    if (toEyes.dot(back) < turnedToEyes) return false;
    // The axis is free from here on: a head looks along −Z.
    return toEyes.dot(across.set(0, 0, 1).applyQuaternion(this.#head.copy(frame.head.orientation))) > lookedAt;
  }
}
