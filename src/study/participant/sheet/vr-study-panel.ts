import { Group, Vector3 } from 'three';
import type { Pointer } from 'threepoint/core';
import { wrapAngle } from 'threepoint/math';
import { createPanelTouch, createVrPanel } from 'threepoint-ui/vr';
import { height, pixelsPerMetre, type Target, width } from '../questions/sheet-target';
import type { StudyScreen } from '../questions/study-screen';
import { paintSheet, targetsOf } from './study-sheet';

/** A head in the floor frame [m]. */
interface SeenHead {
  readonly position: { readonly x: number; readonly y: number; readonly z: number };
  readonly forward: { readonly x: number; readonly z: number };
}

/** The distance of the sheet from the eyes, and how far its centre is below them [m]. */
const reach = 1.25;
const below = 0.12;
/**
 * The sheet is moved in front of a participant who turns [rad], steps [m], sits down or rises [m] by more than this.
 */
const maxTurn = 0.7;
const maxStep = 0.8;
const maxRise = 0.3;

/** The sheet of the study in the headset, a little beyond arm's length, with targets as large as a palm. */
export class VrStudyPanel {
  readonly object = new Group();
  readonly #panel = createVrPanel(width, height, pixelsPerMetre);
  readonly #touch = createPanelTouch<Target>(this.#panel, 'study');
  readonly #centre = new Vector3();
  #screen: StudyScreen | null = null;
  #targets: readonly Target[] = [];
  /** The targets that can be pressed. */
  #enabled: readonly Target[] = [];
  #hovered: string | null = null;
  #drawn = '';
  #placed = false;

  constructor() {
    this.object.add(this.#panel.mesh);
    this.object.visible = false;
  }

  /** The id of the target that a hand points at; null: none. */
  get pointedAt(): string | null {
    return this.#hovered;
  }

  /** null hides it. */
  show(screen: StudyScreen | null): void {
    this.#screen = screen;
    this.#targets = screen ? targetsOf(screen) : [];
    this.#enabled = this.#targets.filter(({ look }) => look !== 'off');
    if (!screen) this.#placed = false;
    this.object.visible = this.#placed;
    this.#redraw();
  }

  /** Places the sheet in front of a head (floor frame). Called with every frame. */
  follow({ position, forward }: SeenHead): void {
    if (!this.#screen) return;
    const { object } = this;
    const yaw = Math.atan2(-forward.x, -forward.z);
    if (this.#placed && !this.#isOutOfView(position, yaw)) return;
    object.rotation.y = yaw;
    object.position.set(position.x - reach * Math.sin(yaw), position.y - below, position.z - reach * Math.cos(yaw));
    this.#placed = true;
    object.visible = true;
  }

  point(pointers: readonly Pointer[]): void {
    if (!this.object.visible) return;
    const { pointedAt, pressed } = this.#touch.follow(pointers, this.#enabled);
    this.#hovered = pointedAt?.id ?? null;
    // Only the first press acts, because it may have changed the screen.
    pressed[0]?.act();
    this.#redraw();
  }

  /** Returns the centre of each target in the world [m]. */
  targets(): readonly { readonly id: string; readonly at: readonly [number, number, number] }[] {
    if (!this.object.visible) return [];
    const { mesh } = this.#panel;
    mesh.updateWorldMatrix(true, false);
    return this.#enabled.map(({ id, at: [x, y, w, h] }) => {
      const {
        x: across,
        y: up,
        z: deep,
      } = mesh.localToWorld(
        this.#centre.set((x + w / 2 - width / 2) / pixelsPerMetre, (height / 2 - y - h / 2) / pixelsPerMetre, 0),
      );
      return { id, at: [across, up, deep] as const };
    });
  }

  /**
   * Returns whether a participant at this eye position [m, floor frame] with this heading [rad] no longer faces the
   * sheet.
   */
  #isOutOfView({ x, y, z }: { readonly x: number; readonly y: number; readonly z: number }, yaw: number): boolean {
    const { position, rotation } = this.object;
    const turn = yaw - rotation.y;
    // The position of the participant when the sheet was placed.
    const fromX = position.x + reach * Math.sin(rotation.y);
    const fromZ = position.z + reach * Math.cos(rotation.y);
    const rise = y - below - position.y;
    return (
      Math.abs(wrapAngle(turn)) >= maxTurn || Math.hypot(fromX - x, fromZ - z) >= maxStep || Math.abs(rise) >= maxRise
    );
  }

  #redraw(): void {
    const screen = this.#screen;
    if (!screen) return;
    // The progress bar moves in hundredths, because every upload of the texture takes time.
    const key = JSON.stringify([screen, this.#hovered], (_, value) =>
      typeof value === 'number' ? Math.round(value * 100) / 100 : value,
    );
    if (key === this.#drawn) return;
    this.#drawn = key;
    this.#panel.draw((context) => paintSheet(context, screen, { targets: this.#targets, hovered: this.#hovered }));
  }
}
