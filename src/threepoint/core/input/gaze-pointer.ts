import { clamp } from '../math/damper';
import type { Pose } from '../math/pose';
import { rotate } from '../math/quat';
import { copyVec3, forward } from '../math/vec3';
import { MovedPointer, type PointedAt, usualDwell } from './pointer';

/** A gaze that passes over something for less than this time [s] holds nothing. */
const settleSeconds = 0.25;
/** A gaze may leave what it rests on for this time [s]: a head is never still. */
const leaveSeconds = 0.15;

/**
 * A pointer along the head's gaze that acts on what it rests on. It acts once: the gaze must move to something else
 * before it acts again.
 */
export class GazePointer extends MovedPointer {
  override readonly releases = false;
  /** What it rests on; the id is null where it rests on nothing. */
  #owner = '';
  #id: string | null = null;
  #since = 0;
  #seenAt = 0;
  #acted = false;

  constructor() {
    super('gaze');
  }

  /** Moves it to a head (floor frame) at a time [s]. Call it in every frame. */
  follow(time: number, head: Pose<'floor'>): void {
    const target = this.begin();
    copyVec3(head.position, this.origin);
    rotate(head.orientation, forward, this.direction);
    const id = target?.id ?? null;
    const stays = id === this.#id && (id === null || target?.owner === this.#owner);
    if (stays) this.#seenAt = time;
    else if (id !== null || time - this.#seenAt > leaveSeconds) this.#restOn(target, time);
    if (!target || id === null || this.#acted) return;
    const seconds = target.dwellSeconds ?? usualDwell;
    this.progress = clamp((time - this.#since - settleSeconds) / (seconds - settleSeconds), this.progress, 1);
    this.held = this.progress > 0;
    if (this.progress < 1) return;
    this.pressed = true;
    this.#release();
    this.#acted = true;
  }

  /** Ends a hold without its action: the head is not seen, or another pointer is in use. */
  cancel(): void {
    this.begin();
    this.#restOn(null, this.#seenAt);
  }

  #restOn(target: PointedAt | null, time: number): void {
    this.cancelled = this.held;
    this.#release();
    this.#acted = false;
    this.#owner = target?.owner ?? '';
    this.#id = target?.id ?? null;
    this.#since = time;
    this.#seenAt = time;
  }

  #release(): void {
    this.held = false;
    this.progress = 0;
  }
}
