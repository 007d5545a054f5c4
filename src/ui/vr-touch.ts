import type { Mutable, Pointer, PointerTarget } from 'threepoint/core';
import type { PanelPoint, VrPanel } from './vr-panel';

/** A finger tip that comes from this far before the sheet [m] to behind it touches. */
const touchDepth = 0.015;
/** A finger tip this near the sheet [m] points at what lies under it. */
const hoverDepth = 0.08;

/** Something on a panel that can be pressed: left, top, width and height on its canvas [pixels]. */
export interface PanelTarget {
  readonly id: string;
  readonly at: readonly [number, number, number, number];
}

/** What pointers do on a panel in a frame. */
interface Touched<Target extends PanelTarget> {
  readonly pointedAt: Target | null;
  /** A target that two pointers press is here once. */
  readonly pressed: readonly Target[];
}

/** Rays and finger tips on one panel. */
interface PanelTouch<Target extends PanelTarget> {
  /**
   * Returns what the pointers point at and press in this frame; the next frame overwrites it. Reports to the pointers
   * what they point at.
   */
  follow(pointers: readonly Pointer[], targets: readonly Target[]): Touched<Target>;
}

const contains = ({ at }: PanelTarget, { x, y }: PanelPoint): boolean =>
  x >= at[0] && x <= at[0] + at[2] && y >= at[1] && y <= at[1] + at[3];

function targetAt<Target extends PanelTarget>(targets: readonly Target[], point: PanelPoint): Target | null {
  for (const target of targets) if (contains(target, point)) return target;
  return null;
}

/**
 * `owner`: the part of the page that the panel belongs to. `countsRay`: whether the ray of a pointer counts; its finger
 * tip always does.
 */
export function createPanelTouch<Target extends PanelTarget>(
  panel: VrPanel,
  owner: string,
  countsRay: (pointer: Pointer) => boolean = () => true,
): PanelTouch<Target> {
  const behind = new WeakMap<Pointer, boolean>();
  /** The target that a gaze has pressed and whose place it has not left since. */
  const pressedPlace = new WeakMap<Pointer, Target>();
  const point: PanelPoint = { x: 0, y: 0, distance: 0 };
  const met: Mutable<PointerTarget> = { distance: 0, owner, id: null };
  const pressed: Target[] = [];
  const touched: Mutable<Touched<Target>> = { pointedAt: null, pressed };

  function press(target: Target): void {
    if (!pressed.includes(target)) pressed.push(target);
  }

  /** Returns the target at `point`; null for one that has replaced the target that this gaze pressed here. */
  function rayTarget(pointer: Pointer, targets: readonly Target[]): Target | null {
    const target = targetAt(targets, point);
    const last = pressedPlace.get(pointer);
    if (!last) return target;
    if (contains(last, point)) return target?.id === last.id ? target : null;
    pressedPlace.delete(pointer);
    return target;
  }

  function followRay(pointer: Pointer, targets: readonly Target[]): void {
    if (!panel.meet(pointer, point)) {
      pressedPlace.delete(pointer);
      return;
    }
    const target = rayTarget(pointer, targets);
    // The sheet itself covers what lies behind it; nothing on it can be rested on but a target.
    met.distance = point.distance;
    met.id = target?.id ?? null;
    pointer.pointAt(met);
    if (!target) return;
    touched.pointedAt = target;
    if (!pointer.pressed) return;
    press(target);
    // A gaze cannot end its hold: without this it would go on to press what replaces the target.
    if (!pointer.releases) pressedPlace.set(pointer, target);
  }

  function followTip(pointer: Pointer, targets: readonly Target[]): void {
    const tip = pointer.tip ?? (pointer.source === 'controller' ? pointer.origin : null);
    if (!tip) return;
    const { distance } = panel.locate(tip, point);
    const target = Math.abs(distance) < hoverDepth ? targetAt(targets, point) : null;
    if (target) touched.pointedAt = target;
    // Only coming from the front counts: a hand that was behind the sheet has touched nothing.
    if (target && distance < 0 && behind.get(pointer) === false) press(target);
    if (distance < 0) behind.set(pointer, true);
    else if (distance > touchDepth) behind.set(pointer, false);
  }

  return {
    follow(pointers, targets) {
      touched.pointedAt = null;
      pressed.length = 0;
      for (const pointer of pointers) {
        if (countsRay(pointer)) followRay(pointer, targets);
        followTip(pointer, targets);
      }
      return touched;
    },
  };
}
