import { clamp } from '../math/damper';
import type { Pose } from '../math/pose';
import { rotate } from '../math/quat';
import { copyVec3, forward } from '../math/vec3';
import { defaultDwellSeconds, MutablePointer, type PointerTarget } from './pointer';

/** The time [s] that a gaze must rest on a target before a hold starts. */
const settleSeconds = 0.25;
/** The time [s] for which a gaze may leave its target, because a head is never still. */
const leaveSeconds = 0.15;

/**
 * A pointer along the head's gaze that activates the target on which it rests. It activates a target once: the gaze
 * must move to another target before it acts again.
 */
export class GazePointer extends MutablePointer {
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
    const seconds = target.dwellSeconds ?? defaultDwellSeconds;
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

  #restOn(target: PointerTarget | null, time: number): void {
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
