import { type Buttons, type Calibration, nothingPressed, type TrackingFrame } from 'threepoint/core';
import type { SimulatedInput } from 'threepoint-games';
import type { Actor } from '../../emulator/actor';
import type { StageParts } from '../stage/stage-parts';
import type { Pointers } from './pointers';

/**
 * The source of the tracked frames: a session, a replay, a simulated player, the actor, or the emulator outside of a
 * session.
 */
export class TrackingSource {
  readonly #parts: StageParts;
  readonly #pointers: Pointers;
  readonly #actor: Actor;
  #buttons: Buttons = nothingPressed;
  #newest: TrackingFrame | null = null;
  /** A pointer steered the player in the last frame. */
  #steered = false;

  constructor(parts: StageParts, pointers: Pointers, actor: Actor) {
    this.#parts = parts;
    this.#pointers = pointers;
    this.#actor = actor;
  }

  /** The buttons of the newest frame. */
  get buttons(): Buttons {
    return this.#buttons;
  }

  /**
   * The calibration of the person who moves the body without a headset: the person in a recording, else the user.
   * null: a headset is worn.
   */
  get standIn(): Calibration | null {
    const { headset, recorder, body } = this.#parts;
    return headset.worn ? null : (recorder.person ?? body.userCalibration);
  }

  /** The newest tracked frame; null: none yet. */
  get newest(): TrackingFrame | null {
    return this.#newest;
  }

  /** Head and hands at this time [s], floor frame; null: the head is not seen. */
  read(time: number, deviceFrame: XRFrame | undefined): TrackingFrame | null {
    this.#buttons = nothingPressed;
    this.#parts.activities.current?.begin?.(time);
    const frame = this.#parts.headset.worn ? this.#readSession(time, deviceFrame) : this.#readDesktop(time);
    this.#newest = frame ?? this.#newest;
    return frame;
  }

  #readSession(time: number, deviceFrame: XRFrame | undefined): TrackingFrame | null {
    const { headset, tracker, settings, study, recorder } = this.#parts;
    // A file may arrive in a session: the wearer's body neither follows its replay nor stands still with it.
    recorder.endReplay();
    if (headset.emulator && settings.actor && !study.run?.idle) {
      // What the actor does now is seen with the next frame: the device froze this one before it called.
      const performed = this.#perform(time);
      headset.emulator.drive(performed.frame, performed.buttons);
    }
    const tracked = deviceFrame ? tracker.read(deviceFrame, time) : null;
    this.#buttons = tracker.tracking?.inputs.buttons ?? nothingPressed;
    this.#pointers.follow(time, tracked?.suspended ? null : (tracked?.head ?? null));
    return tracked && this.#steer(tracked);
  }

  /** Gives the user the hands of a player that a pointer steers, where no hand is tracked. */
  #steer(tracked: TrackingFrame): TrackingFrame {
    const performed = this.#pointers.steering && this.#parts.activities.act(tracked.time);
    const changed = this.#steered !== Boolean(performed);
    this.#steered = Boolean(performed);
    // The move from one player's hands to the other's is no gesture.
    const suspended = changed ? ({ suspended: true } as const) : {};
    if (!performed) return changed ? { ...tracked, ...suspended } : tracked;
    this.#buttons = performed.buttons;
    const { leftHand, rightHand } = performed.frame;
    const { fingers: _, ...seen } = tracked;
    return { ...seen, leftHand, rightHand, ...suspended };
  }

  #readDesktop(time: number): TrackingFrame | null {
    const { recorder, activities, settings, headset } = this.#parts;
    const replayed = recorder.sample(time);
    if (replayed) return replayed;
    if (activities.current?.watched) return null;
    // Before a real headset is put on, and while the emulated one loads, no one moves: the body stands there.
    if (!settings.actor) return headset.emulator?.read(time) ?? this.#actor.standAt(time);
    const performed = this.#perform(time);
    this.#buttons = performed.buttons;
    return performed.frame;
  }

  /** Returns the input of the activity's simulated player, else of the actor. */
  #perform(time: number): SimulatedInput {
    return this.#parts.activities.act(time) ?? { frame: this.#actor.frameAt(time), buttons: nothingPressed };
  }
}
