import type { BodySolver } from 'threepoint';
import { type Buttons, type Calibration, nothingPressed, type TrackingFrame } from 'threepoint/core';
import type { TrackedSession } from 'threepoint/webxr';
import type { SimulatedInput } from 'threepoint-games';
import type { StudyRun } from 'threepoint-study/participant';
import type { Actor } from '../../emulator/actor';
import type { Recorder } from '../../studio/recorder';
import type { Activities } from '../activities/activities';
import type { Headset } from '../headset';
import type { Settings } from '../settings';
import type { Pointers } from './pointers';

/** The part of a session's tracking that is read. */
type SessionTracking = Pick<TrackedSession, 'read'> & { readonly inputs: Pick<TrackedSession['inputs'], 'buttons'> };

export interface TrackingSourceOptions {
  readonly settings: Pick<Settings, 'actor'>;
  readonly headset: Pick<Headset, 'emulator'> & { readonly tracking: SessionTracking | null };
  readonly recorder: Recorder;
  readonly body: Pick<BodySolver, 'userCalibration'>;
  readonly actor: Actor;
  readonly activities: Pick<Activities, 'current' | 'act'>;
  readonly study: { readonly run: Pick<StudyRun, 'idle'> | null };
  readonly pointers: Pick<Pointers, 'follow' | 'steering'>;
}

/**
 * The source of the tracked frames: a session, a replay, a simulated player, the actor, or the emulator outside of a
 * session.
 */
export class TrackingSource {
  readonly #options: TrackingSourceOptions;
  #buttons: Buttons = nothingPressed;
  #newest: TrackingFrame | null = null;
  /** A pointer steered the player in the last frame. */
  #steered = false;

  constructor(options: TrackingSourceOptions) {
    this.#options = options;
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
    const { headset, recorder, body } = this.#options;
    return headset.tracking ? null : (recorder.person ?? body.userCalibration);
  }

  /** The newest tracked frame; null: none yet. */
  get newest(): TrackingFrame | null {
    return this.#newest;
  }

  /** Head and hands at this time [s], floor frame; null: the head is not seen. */
  read(time: number, deviceFrame: XRFrame | undefined): TrackingFrame | null {
    this.#buttons = nothingPressed;
    this.#options.activities.current?.begin?.(time);
    const { tracking } = this.#options.headset;
    const frame = tracking ? this.#readSession(tracking, time, deviceFrame) : this.#readDesktop(time);
    this.#newest = frame ?? this.#newest;
    return frame;
  }

  #readSession(tracking: SessionTracking, time: number, deviceFrame: XRFrame | undefined): TrackingFrame | null {
    const { headset, settings, study, recorder, pointers } = this.#options;
    // A file may arrive in a session: the wearer's body neither follows its replay nor stands still with it.
    recorder.endReplay();
    if (headset.emulator && settings.actor && !study.run?.idle) {
      // What the actor does now is seen with the next frame: the device froze this one before it called.
      const performed = this.#perform(time);
      headset.emulator.drive(performed.frame, performed.buttons);
    }
    const tracked = deviceFrame ? tracking.read(deviceFrame, time) : null;
    this.#buttons = tracking.inputs.buttons;
    pointers.follow(time, tracked?.suspended ? null : (tracked?.head ?? null));
    return tracked && this.#steer(tracked);
  }

  /** Gives the user the hands of a player that a pointer steers, where no hand is tracked. */
  #steer(tracked: TrackingFrame): TrackingFrame {
    const { pointers, activities } = this.#options;
    const performed = pointers.steering && activities.act(tracked.time);
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
    const { recorder, activities, settings, headset, actor } = this.#options;
    const replayed = recorder.sample(time);
    if (replayed) return replayed;
    if (activities.current?.watched) return null;
    // Before a real headset is put on, and while the emulated one loads, no one moves: the body stands there.
    if (!settings.actor) return headset.emulator?.read(time) ?? actor.standAt(time);
    const performed = this.#perform(time);
    this.#buttons = performed.buttons;
    return performed.frame;
  }

  /** Returns the input of the activity's simulated player, else of the actor. */
  #perform(time: number): SimulatedInput {
    const { activities, actor } = this.#options;
    return activities.act(time) ?? { frame: actor.frameAt(time), buttons: nothingPressed };
  }
}
