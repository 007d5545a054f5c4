import { Group, Vector3 } from 'three';
import type { Pointer } from 'threepoint/core';
import type { Pose } from 'threepoint/math';
import type { FrameReport } from 'threepoint-ui';
import { createPanelTouch, createVrPanel } from 'threepoint-ui/vr';
import { type MenuButton, menuHeight, menuWidth } from '../../../activity/activity-menu';
import { menuButtons, type VrMenuActions, type VrMenuState } from './menu-buttons';
import { drawFrameTimes, drawMenu, frameTimesHeight, frameTimesWidth } from './menu-drawing';

const pixelsPerMetre = 1000;

/** The place of the menu, right of the mirror as its user sees it. */
const beside = { position: [1.08, 1.3, -0.97], turned: -0.84 } as const;
/** The place of a menu that was brought: this far ahead of the eyes and below them [m], in reach of a finger. */
const brought = { ahead: 0.52, below: 0.14, scale: 0.5 };

/** The menu right of the mirror, or before the user, and the frame times left of the mirror. */
export class VrMenu {
  readonly object = new Group();
  readonly #menu = createVrPanel(menuWidth, menuHeight, pixelsPerMetre);
  readonly #frameTimes = createVrPanel(frameTimesWidth, frameTimesHeight, pixelsPerMetre);
  readonly #touch = createPanelTouch<MenuButton>(this.#menu, 'menu');
  readonly #actions: VrMenuActions;
  #state: VrMenuState | null = null;
  #buttons: readonly MenuButton[] = [];
  #usable: readonly MenuButton[] = [];
  #hovered: string | null = null;
  #brought = false;
  /** What the sheet shows, as a text that changes with it. */
  #drawn = '';

  constructor(actions: VrMenuActions) {
    this.#actions = actions;
    this.sendBack();
    this.#frameTimes.mesh.position.set(-1.1, 1.35, -1.15);
    this.#frameTimes.mesh.rotation.y = 0.74;
    this.object.add(this.#menu.mesh, this.#frameTimes.mesh);
    this.object.visible = false;
  }

  get isPointedAt(): boolean {
    return this.object.visible && this.#hovered !== null;
  }

  get isBrought(): boolean {
    return this.#brought;
  }

  /** Brings the menu before a head (floor frame). */
  bring({ position, orientation }: Pose<'floor'>): void {
    const { mesh } = this.#menu;
    this.#brought = true;
    const ahead = new Vector3(0, 0, -1).applyQuaternion(mesh.quaternion.copy(orientation)).setY(0).normalize();
    const at = ahead.multiplyScalar(brought.ahead).add(position);
    at.y -= brought.below;
    this.object.updateWorldMatrix(true, false);
    mesh.position.copy(this.object.worldToLocal(at));
    mesh.lookAt(new Vector3().copy(position));
    mesh.scale.setScalar(brought.scale);
  }

  /** Puts the menu back beside the mirror. */
  sendBack(): void {
    const { mesh } = this.#menu;
    this.#brought = false;
    mesh.position.set(...beside.position);
    mesh.rotation.set(0, beside.turned, 0);
    mesh.scale.setScalar(1);
  }

  setVisible(visible: boolean): void {
    this.object.visible = visible;
  }

  show(state: VrMenuState): void {
    this.#state = state;
    this.#frameTimes.mesh.visible = state.overlay;
    this.#redraw();
  }

  showReport(report: FrameReport): void {
    if (!this.object.visible || !this.#frameTimes.mesh.visible) return;
    this.#frameTimes.draw((context) => drawFrameTimes(context, report));
  }

  /** Follows rays and finger tips; a press or a touch on a button is its action. */
  point(pointers: readonly Pointer[]): void {
    if (!this.object.visible) return;
    const { pointedAt, pressed } = this.#touch.follow(pointers, this.#usable);
    const hovered = pointedAt?.id ?? null;
    const moved = hovered !== this.#hovered;
    this.#hovered = hovered;
    for (const { act } of pressed) act();
    // What a press has changed is shown by `show`: a frame in which nothing moves makes no text of the state.
    if (moved) this.#redraw();
  }

  #redraw(): void {
    const state = this.#state;
    if (!state) return;
    // Tenths of the measuring are as fine as a hand-held bar needs; every texture upload costs.
    const key = JSON.stringify([state, this.#hovered], (_, value) =>
      typeof value === 'number' ? Math.ceil(value * 20) / 20 : value,
    );
    if (key === this.#drawn) return;
    this.#drawn = key;
    this.#buttons = menuButtons(state, this.#actions);
    this.#usable = this.#buttons.filter(({ look }) => look !== 'off');
    this.#menu.draw((context) => drawMenu(context, state, this.#buttons, this.#hovered));
  }
}
