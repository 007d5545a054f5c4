import { GazePointer, type Pointer } from 'threepoint/core';
import type { Pose } from 'threepoint/math';
import type { SessionParts } from '../session/session-parts';

/** Hands that have not been seen for this time [s] do not play: a pointer does. */
const handsGoneSeconds = 1;
/** A session without hands and pinches offers the gaze after this time [s]. */
const offerSeconds = 3;

const isTransient = ({ source }: Pointer): boolean => source === 'transient';

/** The pointers of a session: those of its input sources, and the gaze where its user chose it or was offered it. */
export class Pointers {
  readonly #parts: SessionParts;
  readonly #gaze = new GazePointer();
  readonly #all: Pointer[] = [];
  #tracking: object | null = null;
  /** The time of the session's first frame [s]. */
  #began = 0;
  /** The newest pinch of a device that reports no hands; it stays after its end, for what it released. */
  #transient: Pointer | null = null;
  #steering: Pointer | null = null;
  #offers = false;

  constructor(parts: SessionParts) {
    this.#parts = parts;
  }

  /** The pointers of the newest frame. */
  get all(): readonly Pointer[] {
    return this.#all;
  }

  /** The pointer that plays in place of hands; null: hands are tracked, or no pointer is in use. */
  get steering(): Pointer | null {
    return this.#steering;
  }

  /** Nothing points: the gaze is offered. */
  get offersGaze(): boolean {
    return this.#offers;
  }

  /**
   * Reads the pointers of a session's frame at a time [s]. `head`: floor frame; null: not seen, or not for the page.
   */
  follow(time: number, head: Pose<'floor'> | null): void {
    const { headset, settings } = this.#parts;
    const { tracking } = headset;
    if (tracking !== this.#tracking) this.#restart(tracking, time);
    this.#all.length = 0;
    const pointing = tracking?.inputs.pointing;
    if (!pointing) return;
    for (const pointer of pointing.pointers) this.#all.push(pointer);
    const without = time - Math.max(pointing.handsSeenAt, this.#began);
    const pinch = this.#all.find(isTransient) ?? null;
    this.#transient = pinch ?? this.#transient;
    this.#offers = head !== null && !settings.gaze && this.#transient === null && without > offerSeconds;
    const gazes = head !== null && !pinch && (settings.gaze || this.#offers);
    if (gazes) {
      this.#gaze.follow(time, head);
      this.#all.push(this.#gaze);
    } else this.#gaze.cancel();
    const steers = pinch ?? (settings.gaze && head ? this.#gaze : this.#transient);
    this.#steering = without > handsGoneSeconds ? steers : null;
  }

  #restart(tracking: object | null, time: number): void {
    this.#tracking = tracking;
    this.#began = time;
    this.#transient = null;
    this.#steering = null;
    this.#offers = false;
  }
}
