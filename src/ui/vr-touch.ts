import { Raycaster, Vector3 } from 'three';
import type { Pointer } from 'threepoint/core/input/pointer';
import type { VrPanel } from './vr-panel';

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
   * Returns what the pointers point at and press in this frame; a target pressed by two of them is pressed once.
   * Reports to the pointers what they point at.
   */
  follow<Target extends PanelTarget>(
    pointers: readonly Pointer[],
    targets: readonly Target[],
  ): { readonly pointedAt: Target | null; readonly pressed: readonly Target[] };
}

/**
 * `owner`: the part of the page that the panel belongs to. `countsRay`: whether the ray of a pointer counts; its finger
 * tip always does.
 */
export function createPanelTouch(
  panel: VrPanel,
  owner: string,
  countsRay: (pointer: Pointer) => boolean = () => true,
): PanelTouch {
  const behind = new WeakMap<Pointer, boolean>();
  const raycaster = new Raycaster();
  const tip = new Vector3();
  return {
    follow<Target extends PanelTarget>(pointers: readonly Pointer[], targets: readonly Target[]) {
      panel.mesh.updateWorldMatrix(true, false);
      const targetAt = (x: number, y: number) =>
        targets.find(({ at: [left, top, w, h] }) => x >= left && x <= left + w && y >= top && y <= top + h);
      let pointedAt: Target | null = null;
      const pressed = new Map<string, Target>();
      for (const pointer of pointers) {
        raycaster.ray.origin.copy(pointer.origin);
        raycaster.ray.direction.copy(pointer.direction);
        const hit = countsRay(pointer) ? raycaster.intersectObject(panel.mesh, false)[0] : undefined;
        if (hit) {
          const { x, y } = panel.locate(hit.point);
          const target = targetAt(x, y);
          // The sheet itself covers what lies behind it; nothing on it can be rested on but a target.
          pointer.pointAt({ distance: hit.distance, owner, id: target?.id ?? null });
          if (target) pointedAt = target;
          if (target && pointer.pressed) pressed.set(target.id, target);
        }
        const touching = pointer.tip ?? (pointer.source === 'controller' ? pointer.origin : null);
        if (!touching) continue;
        const touch = panel.locate(tip.copy(touching));
        const target = Math.abs(touch.distance) < hoverDepth ? targetAt(touch.x, touch.y) : undefined;
        if (target) pointedAt = target;
        const through = target !== undefined && touch.distance < 0;
        // Only coming from the front counts: a hand that was behind the sheet has touched nothing.
        if (through && behind.get(pointer) === false) pressed.set(target.id, target);
        if (through || touch.distance < 0) behind.set(pointer, true);
        else if (touch.distance > touchDepth) behind.set(pointer, false);
      }
      return { pointedAt, pressed: [...pressed.values()] };
    },
  };
}
