import type { BuiltInBody, EstimatorName } from 'threepoint/core';
import type { SkeletonToMap } from '../../bones/skeleton-to-map';
import type { ViewName } from '../../scene/desktop-view';
import type { Recorder } from '../../studio/recorder';
import type { Settings } from '../session/settings';
import type { GripState } from './grip-control';

/** What the recorder is doing; seconds since its start, of how many. */
export type RecorderState = Pick<Recorder, 'mode' | 'paused' | 'seconds' | 'duration' | 'loop' | 'name'>;

/**
 * Kinds of files that recordings can be made into: BVH in metres or centimetres, a VRM Animation, the shown avatar
 * moving, a table of joints.
 */
export type ExportChoice = 'bvh' | 'bvh-cm' | 'vrma' | 'glb' | 'csv';

/** A file that is being made. */
export interface ExportState {
  readonly name: string;
  /** What draws the body in it, in words. */
  readonly method: string;
  /** Share [0, 1] that is done, and seconds for the rest; null: not known yet. */
  readonly fraction: number;
  readonly secondsLeft: number | null;
}

/** Everything that the panel shows, the settings among it. The panel itself has no state. */
export interface PanelState extends Omit<Settings, 'palette' | 'builtInBody'> {
  readonly estimator: EstimatorName;
  /** The reason why an estimator is unavailable; absent: it is available. */
  readonly unavailable: Partial<Readonly<Record<EstimatorName, string>>>;
  readonly view: ViewName;
  readonly avatarName: string;
  /** The state of an avatar that was requested and is not shown; null: there is none. */
  readonly avatarPending: string | null;
  /** Another avatar than ours is shown, or was wanted. */
  readonly builtInAvatarOffered: boolean;
  /** Whether an avatar is loading, which the user can cancel. */
  readonly avatarOnItsWay: boolean;
  /** Whether the shown avatar is a file, whose bones the user can correct. */
  readonly canCorrectBones: boolean;
  /** A file whose bones the user maps; null: none. */
  readonly waitingForBones: SkeletonToMap | null;
  /** Which body of our own is shown; null: another avatar is. */
  readonly builtInBody: BuiltInBody | null;
  /** The colours of a built-in avatar; null: another avatar is shown, which keeps its own. */
  readonly palette: string | null;
  readonly heightCm: number;
  readonly armSpanCm: number;
  readonly forearmCm: number | null;
  readonly eyeHeightCm: number;
  /** The correction of the controllers that were held last; null: none were. */
  readonly grip: GripState | null;
  readonly emulated: boolean;
  readonly recorder: RecorderState;
  readonly exporting: ExportState | null;
  readonly inSession: boolean;
  /** The session shows the room around the user. */
  readonly inPassthrough: boolean;
  /** The frame rate of the worn headset [Hz]; null: it does not report it, or none is worn. */
  readonly rateHz: number | null;
  /** The rates that it offers [Hz]. */
  readonly ratesHz: readonly number[];
  /** Why the worn headset tracks no body; null: it does, or no headset is worn. */
  readonly bodyComplaint: string | null;
}

/** Returns what the button says that ends a session; `passthrough`: the session shows the room around the user. */
export const exitLabel = (passthrough: boolean): string => (passthrough ? 'Exit AR' : 'Exit VR');
