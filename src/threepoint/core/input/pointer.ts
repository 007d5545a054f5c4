import type { Ray } from '../math/ray';
import type { Side } from '../math/side';
import { copyVec3, type MutableVec3, type Vec3, vec3 } from '../math/vec3';

/**
 * What a pointer is. transient: it is there only while its user pinches, touches or presses, and its ray comes from the
 * eyes or the head.
 */
export type PointerSource = 'mouse' | 'controller' | 'hand' | 'transient' | 'gaze';

/** Something that a pointer points at. */
export interface PointerTarget {
  /** The distance along the ray [m]. */
  readonly distance: number;
  /** The part of the page that it belongs to, such as a menu or a game. */
  readonly owner: string;
  /** What a press there would do: another id is another action. null: nothing, as between the buttons of a sheet. */
  readonly id: string | null;
  /** The time after which a gaze that rests there acts [s]; absent: `usualDwell`. */
  readonly dwellSeconds?: number;
}

/** The time after which a gaze that rests on a button presses it [s]. */
export const defaultDwellSeconds = 1.2;

/**
 * A ray, and where there is one a finger tip, with one action. Menus and games know pointers, never devices. Floor
 * frame; the same object in every frame while its input source is there.
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
  /** Its user ends a hold at will; a gaze cannot, so what it holds must end the hold by itself. */
  readonly releases: boolean;
  /** How much of its dwell time a gaze has rested, 0 to 1; 0 for other pointers. */
  readonly progress: number;
  /** The nearest of what it points at in this frame; null: nothing yet. */
  readonly pointedAt: PointerTarget | null;
  /** Reports that the ray meets something. The nearest report of a frame counts. */
  pointAt(target: PointerTarget): void;
  /** Returns whether it is held, and not for another part of the page. */
  isHeldFor(owner: string): boolean;
}

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
  /** The owner of what it pointed at when the hold began; null: it pointed at nothing. */
  #heldFor: string | null = null;
  #wasHeld = false;

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
    if (!this.pointedAt || target.distance < this.pointedAt.distance) this.pointedAt = target;
  }

  isHeldFor(owner: string): boolean {
    return this.held && (this.#heldFor === owner || this.#heldFor === null);
  }
}
