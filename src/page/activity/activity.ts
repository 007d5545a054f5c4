import type { ComponentChild } from 'preact';
import type {
  AvatarPose,
  AvatarRef,
  Buttons,
  Calibration,
  Fingers,
  HapticPulse,
  MutableHandShape,
  PointerTarget,
  TrackingFrame,
} from 'threepoint/core';
import type { ObjectHolds } from 'threepoint/internal/three';
import type { Pose, Ray, Side, Vec3 } from 'threepoint/math';
import type { SimulatedInput } from 'threepoint-games';
import type { TaskPlace, TaskRunner } from 'threepoint-study/participant';
import type { CameraScene } from '../scene/desktop-view';
import type { ActivityContext, ActivitySettings, ActivitySettingsWriter } from './activity-context';
import type { ActivityMenu } from './activity-menu';

/** A person to look at, floor frame. */
export interface Watched {
  readonly pelvis: Vec3;
  readonly eyes: Pose<'floor'>;
}

export interface ActivitySound {
  setMuted(muted: boolean): void;
  /** Lets the browser play sound; rejects if it cannot. */
  unlock(): Promise<void>;
}

/**
 * Returns the part of the play bar that belongs to an activity, in its current state: score, buttons, settings and
 * rules. Called several times a second and after every change.
 */
export type ActivityPanel = () => ComponentChild;

/** A remote player as drawn, for tests and tools. */
export interface PlayerProbe {
  readonly seat: number;
  readonly name: string;
  readonly bot: boolean;
  readonly presence: string;
  readonly opacity: number;
  /** The avatar that the player chose. */
  readonly avatar: AvatarRef;
  /** The avatar that is drawn; null: none yet. */
  readonly drawnAs: AvatarRef | null;
  /** Joints as drawn, floor frame [m]. */
  readonly joints: Readonly<Record<string, readonly [number, number, number]>>;
}

/**
 * An activity that has been loaded and entered. The shell calls it once per frame in this order: `begin`, `act` if no
 * person is tracked, `update`, `grasp` for each hand, `send`, `show`. The optional members are for activities that need
 * them.
 */
export interface OpenActivity {
  readonly sound?: ActivitySound;
  /** The initial view of the desktop camera. Another object moves the camera there. */
  readonly scene: CameraScene;
  /** The side on which the mirror stands, next to a user who faces away from it; null: this activity has no mirror. */
  readonly mirrorSide: Side | null;
  /** The palette that the user's own avatar wears here; null or absent: the user's choice. */
  readonly palette?: string | null;
  /** The person that the desktop camera follows while the user has no body here; null or absent: the user has one. */
  readonly watched?: Watched | null;
  /** How far the user's own mouth is open, from 0 to 1. */
  readonly mouth?: number;
  /** Receives from the network and advances simulated players. */
  begin?(time: number): void;
  /** Returns the input of the simulated player, or of the one that a pointer steers; null: no player is moved. */
  act(time: number): SimulatedInput | null;
  /** Advances the game by a tracked frame. Returns haptic pulses for the hands; null: the game is paused. */
  update(frame: TrackingFrame, buttons: Buttons): readonly HapticPulse[] | null;
  /** Closes a hand around the object that it holds. Returns false if it holds nothing. */
  grasp?(side: Side, wrist: Pose<'floor'>, holding: ObjectHolds, target: MutableHandShape): boolean;
  /** Sends the solved body to other players. */
  send?(frame: TrackingFrame, pose: AvatarPose, fingers: Fingers): void;
  /** Updates the view. `frame`: null if the head is not tracked. */
  show(time: number, frame: TrackingFrame | null): void;
  /** Returns the button in the scene that a ray meets, or null. `press`: also presses the button. */
  point?(ray: Ray, press: boolean): PointerTarget | null;
  /** The user's floor frame changed: movement since the last frame is not a gesture. */
  discontinuity?(): void;
  /** A session started or ended: another input source moves the hands from now on. */
  sessionChanged?(): void;
  calibrate?(calibration: Calibration): void;
  /** Whether the user can see the page: other players are notified. */
  setAway?(away: boolean): void;
  toggleMuted?(): void;
  /** A warning about the connection; null: none. */
  banner?(): string | null;
  /** Creates the part of the play bar; called once. */
  createPanel?(): ActivityPanel;
  /** The part of the menu in the headset. */
  menu?(): ActivityMenu;
  /** The state of the game as plain data, for tests and tools. */
  probe?(): object | null;
  /** The remote players as drawn, for tests and tools. */
  players?(): readonly PlayerProbe[];
  dispose(): void;
}

/** The free floor about the user's place that looks along −Z [m]. */
export interface FloorNeeds {
  readonly halfWidth: number;
  readonly ahead: number;
  readonly behind: number;
}

/** The services of the page for a runner: the activity that a study runs as a task, and the settings. */
export interface RunnerServices<Opened> {
  readonly settings: ActivitySettings;
  readonly writer: ActivitySettingsWriter;
  /** The activity if the user is there now, else null. */
  opened(): Opened | null;
  /**
   * Leaves and re-enters the activity at this place. Returns null if it could not be opened; a notice gives the reason.
   */
  open(place: TaskPlace): Promise<Opened | null>;
  /** Returns to the mirror. */
  leave(): void;
}

/** An activity as a task of a study. */
export interface ActivityRunner extends TaskRunner {
  /** Called after every frame that the activity has played. */
  played(): void;
}

/**
 * Something to do on the page besides looking in the mirror. Implementations are listed in
 * `shell/activity-registry.ts`, which is the only part of the shell that names them. `load` imports the code on first
 * use, so an implementation of this interface must be small.
 *
 * @example
 * export const darts: Activity = {
 *   name: 'darts',
 *   title: 'Darts',
 *   place: 'The dartboard',
 *   load: async (context) => (await import('./darts-activity')).createDarts(context),
 * };
 */
export interface Activity<Opened extends OpenActivity = OpenActivity> {
  /** The value of `play=` in the address, and the name of the task in a study plan. */
  readonly name: string;
  /** The label of its button. */
  readonly title: string;
  /** The place with its article, which starts the sentence of a notice if it cannot be opened. */
  readonly place: string;
  /** The free floor that the activity needs in the user's own room; absent: it is never shown there. */
  readonly floor?: FloorNeeds;
  /** Loads and enters the activity. Rejects with a reason. */
  load(context: ActivityContext): Promise<Opened>;
  /** Makes the task that studies run; absent: no study can use this activity. */
  createRunner?(services: RunnerServices<Opened>): Promise<ActivityRunner>;
}
