import {
  type Buttons,
  firstLine,
  type HandGeometry,
  type HapticPulse,
  type MutableHandShape,
  reasonOf,
  type TrackingFrame,
} from 'threepoint/core';
import { ObjectHolds } from 'threepoint/internal/three';
import type { Pose, Side } from 'threepoint/math';
import type { SimulatedInput } from 'threepoint-games';
import type { TaskPlace } from 'threepoint-study/participant';
import type { MouseAim } from 'threepoint-ui';
import type { Activity, OpenActivity } from '../../activity/activity';
import type { ActivityContext, ActivityServices, InputSource } from '../../activity/activity-context';
import { home } from '../activity-registry';
import { ActivityStaging } from './activity-staging';
import type { DrawingParts } from './drawing-parts';
import type { Picture } from './stage';
import { unlockSound } from './unlock-sound';

export interface ActivitiesOptions extends DrawingParts {
  readonly activities: readonly Activity[];
  /** The seed of the first layout. */
  readonly seed: number;
  readonly mouse: MouseAim;
  readonly pointer: ActivityServices['pointer'];
  readonly fetchBuiltInAvatar: ActivityServices['fetchBuiltInAvatar'];
  readonly onCaption: ActivityServices['onCaption'];
  /** The user is somewhere else now: filters and clocks restart. */
  onArrival(): void;
}

/** The activity that the user is in, and the way from one to another. Knows activities by their interface only. */
export class Activities {
  readonly #options: ActivitiesOptions;
  readonly #holding = new ObjectHolds();
  readonly #layout: { seed: number };
  readonly #staging: ActivityStaging;
  #name = home as string;
  #current: OpenActivity | null = null;
  #arriving = false;
  /** The seat that a study assigned; null: none. */
  #place: TaskPlace | null = null;
  /** Cancels the wait for the user's first touch, which lets the browser play sound. */
  #cancelSound: () => void = () => undefined;

  constructor(options: ActivitiesOptions) {
    this.#options = options;
    this.#staging = new ActivityStaging(options, options.mouse);
    this.#layout = { seed: options.seed };
  }

  get all(): readonly Activity[] {
    return this.#options.activities;
  }

  /** The name of the current activity, or that of the mirror. */
  get name(): string {
    return this.#name;
  }

  /** null: the user is at the mirror. */
  get current(): OpenActivity | null {
    return this.#current;
  }

  get arriving(): boolean {
    return this.#arriving;
  }

  get inputSource(): InputSource {
    const { recorder, headset, settings } = this.#options;
    if (!headset.worn && recorder.mode === 'replaying') return 'recording';
    if (headset.worn || !settings.actor) return 'headset';
    return settings.mouse ? 'mouse' : 'actor';
  }

  /** Goes to an activity by its name. If it cannot be opened, the user sees a notice and is at the mirror. */
  async goTo(name: string): Promise<void> {
    if (this.#arriving || name === this.#name) return;
    this.#leave();
    const next = this.all.find((activity) => activity.name === name);
    if (next) await this.#open(next);
    this.#options.writer.change({ following: null });
    this.#staging.arrange(this.#current, true);
    this.#options.onCaption('');
    this.#options.onArrival();
  }

  /** Leaves the current activity and enters it again. */
  async reopen(): Promise<void> {
    const name = this.#name;
    if (this.#arriving || name === home) return;
    this.#leave();
    await this.goTo(name);
  }

  /** Enters an activity at the place that a study assigned. Returns null if it could not be opened. */
  async openAt(name: string, place: TaskPlace): Promise<OpenActivity | null> {
    if (name === this.#name) await this.goTo(home);
    this.#place = place;
    await this.goTo(name);
    return this.openedOf(name);
  }

  /** The activity of this name if the user is there, else null. */
  openedOf(name: string): OpenActivity | null {
    return name === this.#name ? this.#current : null;
  }

  setSound(on: boolean): void {
    const { writer, notices } = this.#options;
    writer.keep({ sound: on });
    const sound = this.#current?.sound;
    this.#cancelSound();
    if (sound) this.#cancelSound = unlockSound(sound, on, notices);
  }

  /**
   * Lets the mouse or the simulated player play while no headset is worn. Ends a replay, which would move the same
   * body.
   */
  chooseInput(source: 'mouse' | 'actor'): void {
    this.#options.recorder.endReplay();
    this.#options.writer.change({ actor: true, mouse: source === 'mouse' });
    this.#staging.arrange(this.#current);
  }

  sessionChanged(): void {
    this.#current?.sessionChanged?.();
    this.#staging.arrange(this.#current);
  }

  /** When the mirror is visible, if the user has not turned it off. */
  get mirror(): Picture['mirror'] {
    if (!this.#current) return 'unless-behind';
    return this.#current.mirrorSide === null ? 'never' : 'always';
  }

  act(time: number): SimulatedInput | null {
    if (this.#options.study.run?.idle) return null;
    return this.#current?.act(time) ?? null;
  }

  /** Advances the activity by a tracked frame; returns haptic pulses. */
  play(frame: TrackingFrame, buttons: Buttons): readonly HapticPulse[] {
    const pulses = this.#current?.update(frame, buttons) ?? null;
    if (pulses === null) return [];
    this.#options.study.runners[this.#name]?.played();
    return pulses;
  }

  /**
   * Closes a hand around the object that it holds. `hand`: the geometry of the avatar's hand; null: unknown. Returns
   * false if it holds nothing.
   */
  grasp(side: Side, wrist: Pose<'floor'>, hand: HandGeometry | null, target: MutableHandShape): boolean {
    this.#holding.fitTo(side, hand, this.#options.body.calibration.eyeHeight);
    return this.#current?.grasp?.(side, wrist, this.#holding, target) ?? false;
  }

  /** Draws the newest frame of play. `frame`: null if the head is not tracked. */
  show(time: number, frame: TrackingFrame | null): void {
    this.#current?.show(time, frame);
    this.#staging.arrange(this.#current);
  }

  async #open(activity: Activity): Promise<void> {
    const { settings, notices, onChange } = this.#options;
    this.#arriving = true;
    onChange();
    try {
      this.#current = await activity.load(this.#context());
      this.#name = activity.name;
      notices.withdraw('activity');
      const { sound } = this.#current;
      if (sound) this.#cancelSound = unlockSound(sound, settings.sound, notices);
    } catch (error) {
      notices.show('error', `${activity.place} could not be opened: ${firstLine(reasonOf(error))}`, 'activity');
    }
    this.#arriving = false;
  }

  #leave(): void {
    // The next round has another layout.
    if (this.#current) this.#layout.seed += 1;
    this.#cancelSound();
    this.#current?.dispose();
    this.#current = null;
    this.#name = home;
  }

  #context(): ActivityContext {
    const inputSource = () => this.inputSource;
    return {
      ...this.#options,
      layout: this.#layout,
      place: this.#place,
      get inputSource() {
        return inputSource();
      },
      chooseInput: (source) => this.chooseInput(source),
      setSound: (on) => this.setSound(on),
      reopen: () => void this.reopen(),
      placeCamera: () => this.#staging.arrange(this.#current, true),
    };
  }
}
