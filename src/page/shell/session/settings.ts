import { type BuiltInBody, defaultAvatar, type SkinTone } from 'threepoint/core';
import type { ActivitySettings } from '../../activity/activity-context';
import type { PreferenceStore, Preferences } from './preferences';
import type { Switches } from './switches';

/** The user's settings for this visit. The object is live; only a SettingsWriter changes it. */
export interface Settings extends ActivitySettings {
  readonly mirror: boolean;
  readonly upperBodyOnly: boolean;
  readonly debugSkeleton: boolean;
  readonly overlay: boolean;
  /** Frame times inside the headset. */
  readonly vrOverlay: boolean;
  readonly largerText: boolean;
  /** Keys without a modifier act: not where speech or a tremor presses them by chance. */
  readonly singleKeys: boolean;
  /** Whether the controls are open if there is space for them beside the picture. */
  readonly panel: boolean;
  /** The colours of a built-in body; `ownColours`: those of its file. */
  readonly palette: string;
  /** The built-in avatar that is worn unless another one is. */
  readonly builtInBody: BuiltInBody;
  /** The skin tone of a human avatar; undefined: the avatar's own. */
  readonly skinTone: SkinTone | undefined;
  /** The emulator's panel for developers is visible while mouse and keys move the headset. */
  readonly emulatorPanel: boolean;
  /**
   * The next session asks the headset for the body that it tracks itself; never remembered, because a browser has
   * crashed when it was asked.
   */
  readonly deviceBody: boolean;
  /** The next session shows the room around the user, if the headset can. */
  readonly passthrough: boolean;
  /** The gaze presses what it rests on, also while hands are tracked. */
  readonly gaze: boolean;
  /** In passthrough the avatar stands beside its user. */
  readonly beside: boolean;
  /** The source of the user's measurements, in words. */
  readonly calibrationSource: string;
}

/** The value of `palette` for a body in its own colours. */
export const ownColours = 'own';

/** The body of a visitor who has not chosen one. A participant of a study has the plain one. */
const firstBody: BuiltInBody = 'woman';

/** Returns the name of a player who gave none: `Guest` and two digits, which a reload of the tab keeps. */
function guestName(tab: Pick<Storage, 'getItem' | 'setItem'> | null): string {
  const key = 'threepoint.guest';
  const stored = tab?.getItem(key) ?? '';
  if (/^\d\d$/.test(stored)) return `Guest ${stored}`;
  const number = 10 + ((crypto.getRandomValues(new Uint8Array(1))[0] ?? 0) % 90);
  try {
    tab?.setItem(key, String(number));
  } catch (error) {
    // A full storage affects only later visits.
    if (!(error instanceof DOMException)) throw error;
  }
  return `Guest ${number}`;
}

/**
 * Creates the settings from the address, else from stored preferences, else from defaults. `tab`: the storage of this
 * tab; null: the browser grants none.
 */
export function createSettings(
  switches: Switches,
  { preferences }: Pick<PreferenceStore, 'preferences'>,
  tab: Pick<Storage, 'getItem' | 'setItem'> | null,
): Settings {
  return {
    mirror: preferences.mirror ?? true,
    upperBodyOnly: preferences.upperBodyOnly ?? false,
    debugSkeleton: false,
    overlay: preferences.overlay ?? false,
    vrOverlay: false,
    largerText: preferences.largerText ?? false,
    singleKeys: preferences.singleKeys ?? true,
    panel: switches.panel ?? preferences.panel ?? true,
    palette: preferences.palette ?? ownColours,
    builtInBody: preferences.builtInBody ?? (switches.study ? defaultAvatar : firstBody),
    skinTone: preferences.skinTone,
    shareAvatar: preferences.shareAvatar ?? true,
    plainOthers: preferences.plainOthers ?? false,
    voicesByRelay: preferences.voicesByRelay ?? false,
    actor: switches.actor,
    mouse: false,
    emulatorPanel: false,
    deviceBody: false,
    passthrough: preferences.passthrough ?? false,
    gaze: preferences.gaze ?? false,
    beside: false,
    bowSide: preferences.bowSide ?? 'left',
    oneHanded: preferences.oneHanded ?? false,
    everyHitCounts: preferences.everyHitCounts ?? false,
    ...(switches.seconds && { seconds: switches.seconds }),
    sound: preferences.sound ?? true,
    bots: switches.bots ?? (switches.room ? false : (preferences.bots ?? true)),
    name: switches.name ?? preferences.name ?? '',
    defaultName: guestName(tab),
    following: null,
    calibrationSource: preferences.calibration ? 'remembered' : 'not calibrated yet',
  };
}

/** The settings that a browser keeps for later visits. */
export type StoredSettings = Partial<Pick<Settings, keyof Settings & keyof Preferences>>;

/** The only writer of the settings. Every change is reported, so that it appears on the screen. */
export class SettingsWriter {
  readonly #settings: Settings;
  readonly #store: Pick<PreferenceStore, 'remember'>;
  readonly #onChange: () => void;

  constructor(settings: Settings, store: Pick<PreferenceStore, 'remember'>, onChange: () => void) {
    this.#settings = settings;
    this.#store = store;
    this.#onChange = onChange;
  }

  /** Changes settings for this visit. */
  change(part: Partial<Settings>): void {
    Object.assign(this.#settings, part);
    this.#onChange();
  }

  /** Changes settings for this visit, and stores them on this device. */
  keep(part: StoredSettings): void {
    this.#store.remember(part);
    this.change(part);
  }
}
