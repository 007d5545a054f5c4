import type { BuiltInBody, Calibration, PageClock, Pointer } from 'threepoint/core';
import type { GazeTargets } from 'threepoint/internal/three';
import type { Pose, Ray, Side } from 'threepoint/math';
import type { OwnAvatar } from 'threepoint-rooms/internal';
import type { StudyRun, TaskPlace } from 'threepoint-study/participant';
import type { Notices, ServerPresence } from 'threepoint-ui';
import type { Quality } from '../scene/renderer';
import type { SurroundingsHost } from '../scene/surroundings';

/** The settings of activities that the browser stores for later visits. */
export interface StoredActivitySettings {
  readonly sound: boolean;
  readonly bowSide: Side;
  readonly oneHanded: boolean;
  readonly everyHitCounts: boolean;
  /** Bots take free seats. */
  readonly bots: boolean;
  /** The player's name; empty: not given. */
  readonly name: string;
  /** Players of the same room see an avatar file of this player. */
  readonly shareAvatar: boolean;
  /** All other players are shown as mannequins. */
  readonly plainOthers: boolean;
  /** Voices are sent through the TURN relay only, which hides the user's address from other players. */
  readonly voicesByRelay: boolean;
}

/** The settings that activities read. The object is live. */
export interface ActivitySettings extends StoredActivitySettings {
  /** A simulated player moves the body while no person does. */
  readonly actor: boolean;
  /** The mouse plays instead of the simulated player while no headset is worn. */
  readonly mouse: boolean;
  /** Rounds wait for a start signal, as in a study; absent: the first arrow starts them too. */
  readonly startSignal?: boolean;
  /** Length of a round [s]; absent: the default of the game. */
  readonly seconds?: number;
  /** The name that others see if the player gave none. */
  readonly defaultName: string;
  /** The seat that a spectator's camera follows; null: the camera is free. */
  readonly following: number | null;
}

export interface ActivitySettingsWriter {
  /** Changes settings for this visit. */
  change(part: Partial<ActivitySettings>): void;
  /** Changes settings for this visit and stores them for later ones. */
  keep(part: Partial<StoredActivitySettings>): void;
}

/** The parts of the page that every activity can use. */
export interface ActivityServices {
  readonly quality: Quality;
  readonly clock: PageClock;
  readonly settings: ActivitySettings;
  readonly writer: ActivitySettingsWriter;
  readonly switches: {
    readonly room: string | null;
    readonly spectate: boolean;
    readonly seconds: number | null;
    readonly balls: number | null;
  };
  readonly stage: {
    readonly studio: SurroundingsHost;
    readonly view: { readonly pose: Pose<'floor'>; rayThrough(x: number, y: number): Ray };
  };
  /**
   * Returns the pointer that steers a player here: the mouse, or in a headset a gaze or a pinch while no hand is
   * tracked. null: hands or a simulated player play.
   */
  pointer(): Pointer | null;
  readonly headset: { readonly worn: boolean; readonly emulator: object | null };
  readonly body: { readonly calibration: Calibration };
  /** The user's avatar; `isBuiltIn`: it is a built-in one, not a file. */
  readonly avatar: { readonly isBuiltIn: boolean; readonly worn: OwnAvatar };
  fetchBuiltInAvatar(name: BuiltInBody): Promise<ArrayBuffer>;
  /** What attracts the eyes of avatars in this frame, floor frame; the page clears it. */
  readonly gazeTargets: GazeTargets;
  readonly server: Pick<ServerPresence, 'state' | 'whenKnown' | 'refresh'>;
  readonly notices: Pick<Notices, 'show' | 'withdraw'>;
  /** Whether the user asked for reduced motion. */
  readonly calm: { readonly matches: boolean };
  /** The study that the user takes part in; `run`: null without one. */
  readonly study: { readonly run: Pick<StudyRun, 'idle' | 'paused'> | null };
  onCaption(text: string): void;
  /** Call after a change that a panel or a menu shows. */
  onChange(): void;
}

/** The input source that moves the player. */
export type InputSource = 'recording' | 'headset' | 'mouse' | 'actor';

/**
 * Returns whether drawn bodies breathe and shift their weight: in a study and in a replay bodies are as they were
 * measured, and with reduced motion they rest.
 */
export const showsIdleMotion = ({ calm, study }: Pick<ActivityServices, 'calm' | 'study'>, source: InputSource) =>
  !calm.matches && study.run === null && source !== 'recording';

/** Everything an activity gets when it is entered. */
export interface ActivityContext extends ActivityServices {
  /** The seed of the next layout. Increment it to get another layout. */
  readonly layout: { seed: number };
  /** The seat that a study assigned; null: none. */
  readonly place: TaskPlace | null;
  readonly inputSource: InputSource;
  /** Lets the mouse or the simulated player play while no headset is worn. */
  chooseInput(source: 'mouse' | 'actor'): void;
  setSound(on: boolean): void;
  /** Leaves the activity and enters it again. */
  reopen(): void;
  /** Moves the desktop camera to the activity's scene. */
  placeCamera(): void;
}
