import type { Ray } from '../math/ray';
import type { Side } from '../math/side';
import { copyVec3, type MutableVec3, type Vec3, vec3 } from '../math/vec3';
import type { Mutable } from '../records';

/**
 * The kind of a pointer. transient: it exists only while the user pinches, touches or presses, and its ray starts at
 * the eyes or the head.
 */
export type PointerSource = 'mouse' | 'controller' | 'hand' | 'transient' | 'gaze';

/** A target that a pointer points at. */
export interface PointerTarget {
  /** The distance along the ray [m]. */
  readonly distance: number;
  /** The part of the page that it belongs to, such as a menu or a game. */
  readonly owner: string;
  /** The id of the action of a press; null: no action, as between the buttons of a sheet. */
  readonly id: string | null;
  /** The time after which a gaze that rests there acts [s]; absent: `defaultDwellSeconds`. */
  readonly dwellSeconds?: number;
}

/** The time after which a gaze that rests on a button presses it [s]. */
export const defaultDwellSeconds = 1.2;

/**
 * A ray, with a fingertip if there is one, and one action. Menus and games use pointers and know no devices. Floor
 * frame; the same object in every frame while its input source exists.
 */
export interface Pointer extends Ray {
  readonly source: PointerSource;
  /** The side of its hand; null: it has none. */
  readonly side: Side | null;
  /** The tip of the index finger; null: not seen. */
  readonly tip: Vec3 | null;
  /** The pointer acts in this frame: a trigger or pinch has closed, or a gaze has rested for long enough. */
  readonly pressed: boolean;
  /** The action is held: a trigger or pinch is closed, or a gaze is resting on something. */
  readonly held: boolean;
  /** A hold has ended without its action: the gaze moved away, or the device took the hand. */
  readonly cancelled: boolean;
  /** Whether the user can end a hold. A gaze cannot, so that the target must end it. */
  readonly releases: boolean;
  /** The fraction of the dwell time for which a gaze has rested, 0 to 1; 0 for other pointers. */
  readonly progress: number;
  /** The nearest of what it points at in this frame; null: nothing yet. Overwritten two frames later. */
  readonly pointedAt: PointerTarget | null;
  /** Reports that the ray meets something, which is copied. The nearest report of a frame counts. */
  pointAt(target: PointerTarget): void;
  /** Returns whether it is held, and not for another part of the page. */
  isHeldFor(owner: string): boolean;
}

const noTarget = (): Mutable<PointerTarget> => ({
  distance: 0,
  owner: '',
  id: null,
  dwellSeconds: defaultDwellSeconds,
});

/** A pointer that its reader moves. Call `begin` first in every frame. */
export class MutablePointer implements Pointer {
  readonly source: PointerSource;
  readonly side: Side | null;
  readonly origin: MutableVec3 = vec3(0, 0, 0);
  readonly direction: MutableVec3 = vec3(0, 0, -1);
  tip: MutableVec3 | null = null;
  pressed = false;
  held = false;
  cancelled = false;
  progress = 0;
  readonly releases: boolean = true;
  pointedAt: PointerTarget | null = null;
  readonly #tip = vec3(0, 0, 0);
  /** The owner of the target when the hold began; null: there was none. */
  #heldFor: string | null = null;
  #wasHeld = false;
  /** The buffers of the target of this frame and of the last one. */
  #target = noTarget();
  #lastTarget = noTarget();

  constructor(source: PointerSource, side: Side | null = null) {
    this.source = source;
    this.side = side;
  }

  /** Starts a frame; returns what it pointed at in the last one. */
  begin(): PointerTarget | null {
    const last = this.pointedAt;
    if (!this.held) this.#heldFor = null;
    else if (!this.#wasHeld) this.#heldFor = last?.owner ?? null;
    this.#wasHeld = this.held;
    const target = this.#lastTarget;
    this.#lastTarget = this.#target;
    this.#target = target;
    this.pointedAt = null;
    this.pressed = false;
    this.cancelled = false;
    return last;
  }

  setRay(origin: Vec3, direction: Vec3): void {
    copyVec3(origin, this.origin);
    copyVec3(direction, this.direction);
  }

  setTip(tip: Vec3 | null): void {
    this.tip = tip && copyVec3(tip, this.#tip);
  }

  pointAt(target: PointerTarget): void {
    if (this.pointedAt && target.distance >= this.pointedAt.distance) return;
    const kept = this.#target;
    kept.distance = target.distance;
    kept.owner = target.owner;
    kept.id = target.id;
    kept.dwellSeconds = target.dwellSeconds ?? defaultDwellSeconds;
    this.pointedAt = kept;
  }

  isHeldFor(owner: string): boolean {
    return this.held && (this.#heldFor === owner || this.#heldFor === null);
  }
}
