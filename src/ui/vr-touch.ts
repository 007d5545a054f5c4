import { Raycaster } from 'three';
import type { VrPanel } from './vr-panel';
import type { Pointer } from './vr-pointers';

/** A finger tip that comes from this far before the sheet [m] to behind it touches. */
const touchDepth = 0.015;
/** A finger tip this near the sheet [m] points at what lies under it. */
const hoverDepth = 0.08;

/** Something on a panel that can be pressed: left, top, width and height on its canvas [pixels]. */
export interface PanelTarget {
  readonly id: string;
  readonly at: readonly [number, number, number, number];
}

/** Rays and finger tips on one panel. */
export interface PanelTouch {
  /**
   * What the hands point at and press in this frame; a target pressed by both hands is pressed once. Shows the rays.
   */
  follow<Target extends PanelTarget>(
    pointers: readonly Pointer[],
    targets: readonly Target[],
  ): { readonly pointedAt: Target | null; readonly pressed: readonly Target[] };
}

export function createPanelTouch(panel: VrPanel): PanelTouch {
  const touching = new WeakMap<Pointer, boolean>();
  const raycaster = new Raycaster();
  return {
    follow<Target extends PanelTarget>(pointers: readonly Pointer[], targets: readonly Target[]) {
      panel.mesh.updateWorldMatrix(true, false);
      const targetAt = (x: number, y: number) =>
        targets.find(({ at: [left, top, w, h] }) => x >= left && x <= left + w && y >= top && y <= top + h);
      let pointedAt: Target | null = null;
      const pressed = new Map<string, Target>();
      for (const pointer of pointers) {
        raycaster.set(pointer.origin, pointer.direction);
        const [hit] = raycaster.intersectObject(panel.mesh, false);
        pointer.showRay(hit ? hit.distance : null);
        if (hit) {
          const { x, y } = panel.locate(hit.point);
          const target = targetAt(x, y);
          if (target) pointedAt = target;
          if (target && pointer.pressed) pressed.set(target.id, target);
        }
        const touch = panel.locate(pointer.tip ?? pointer.origin);
        const target = Math.abs(touch.distance) < hoverDepth ? targetAt(touch.x, touch.y) : undefined;
        if (target) pointedAt = target;
        const through = target !== undefined && touch.distance < 0;
        // Only coming from the front counts: a hand that was behind the sheet has touched nothing.
        if (through && touching.get(pointer) === false) pressed.set(target.id, target);
        if (through || touch.distance < 0) touching.set(pointer, true);
        else if (touch.distance > touchDepth) touching.set(pointer, false);
      }
      return { pointedAt, pressed: [...pressed.values()] };
    },
  };
}
