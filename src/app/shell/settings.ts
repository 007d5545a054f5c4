import { type Calibration, defaultCalibration } from '../../core/body/calibration';
import type { Side } from '../../core/math/side';
import type { PreferenceStore } from './preferences';
import type { Switches } from './switches';

/** What the user set, for this visit; whoever changes it brings it on the screen. */
export interface Settings {
  mirror: boolean;
  upperBodyOnly: boolean;
  debugSkeleton: boolean;
  overlay: boolean;
  /** Frame times inside the headset. */
  vrOverlay: boolean;
  largerText: boolean;
  palette: string;
  /** Somebody built in moves the body, where nobody else does. */
  actor: boolean;
  /** In a game, without a headset: the mouse plays instead of the actor. */
  mouse: boolean;
  emulatorPanel: boolean;
  bowSide: Side;
  oneHanded: boolean;
  everyHitCounts: boolean;
  /** Rounds wait for their signal, as a study's do; absent: the first arrow starts them too. */
  startSignal?: boolean;
  /** Of a round, until the bell [s]; absent: as the game has it. */
  seconds?: number;
  sound: boolean;
  bots: boolean;
  /** As given by the player; empty: not given. */
  name: string;
  /** What others call a player who has given no name. */
  readonly guestName: string;
  /** Whom a spectator's camera follows: a seat, or null: free. */
  following: number | null;
  calibration: Calibration;
  /** Where the calibration comes from, in words. */
  calibrationSource: string;
}

/** What the address asks for, else what was remembered, else what suits most. */
export function createSettings(switches: Switches, { preferences }: Pick<PreferenceStore, 'preferences'>): Settings {
  return {
    mirror: preferences.mirror ?? true,
    upperBodyOnly: preferences.upperBodyOnly ?? false,
    debugSkeleton: false,
    overlay: preferences.overlay ?? false,
    vrOverlay: false,
    largerText: preferences.largerText ?? false,
    palette: preferences.palette ?? 'porcelain',
    actor: switches.actor,
    mouse: false,
    emulatorPanel: true,
    bowSide: preferences.bowSide ?? 'left',
    oneHanded: preferences.oneHanded ?? false,
    everyHitCounts: preferences.everyHitCounts ?? false,
    ...(switches.seconds && { seconds: switches.seconds }),
    sound: preferences.sound ?? true,
    bots: switches.bots ?? (switches.room ? false : (preferences.bots ?? true)),
    name: switches.name ?? preferences.name ?? '',
    guestName: `Guest ${10 + ((crypto.getRandomValues(new Uint8Array(1))[0] ?? 0) % 90)}`,
    following: null,
    calibration: preferences.calibration ?? defaultCalibration,
    calibrationSource: preferences.calibration ? 'remembered' : 'not calibrated yet',
  };
}
