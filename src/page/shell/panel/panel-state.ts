import type { BuiltInBody, SkinTone } from 'threepoint/core/body/avatar-ref';
import type { EstimatorName } from 'threepoint/core/estimation/pose-estimator';
import type { BoneMap } from 'threepoint/core/humanoid/bones';
import type { ViewName } from '../../scene/desktop-view';
import type { WaitingForBones } from '../shown-avatar';

/** What the recorder is doing; seconds since its start, of how many. */
export interface RecorderState {
  readonly mode: 'idle' | 'recording' | 'replaying';
  readonly paused: boolean;
  readonly seconds: number;
  readonly duration: number;
  readonly loop: boolean;
  /** The name of the current recording; null: none. */
  readonly name: string | null;
}

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
  readonly share: number;
  readonly secondsLeft: number | null;
}

/** Everything that the panel shows. The panel itself has no state. */
export interface PanelState {
  readonly estimator: EstimatorName;
  /** The reason why an estimator is unavailable; absent: it is available. */
  readonly unavailable: Partial<Readonly<Record<EstimatorName, string>>>;
  readonly view: ViewName;
  readonly mirror: boolean;
  readonly upperBodyOnly: boolean;
  readonly debugSkeleton: boolean;
  readonly overlay: boolean;
  readonly largerText: boolean;
  readonly singleKeys: boolean;
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
  readonly waitingForBones: WaitingForBones | null;
  readonly shareAvatar: boolean;
  readonly plainOthers: boolean;
  /** Which body of our own is shown; null: another avatar is. */
  readonly builtInBody: BuiltInBody | null;
  /** The skin tone of a human avatar; undefined: the avatar's own. */
  readonly skinTone: SkinTone | undefined;
  /** The colours of a built-in avatar; null: another avatar is shown, which keeps its own. */
  readonly palette: string | null;
  readonly heightCm: number;
  readonly armSpanCm: number;
  /** null: not given. */
  readonly forearmCm: number | null;
  readonly eyeHeightCm: number;
  readonly calibrationSource: string;
  readonly actor: boolean;
  readonly emulated: boolean;
  readonly emulatorPanel: boolean;
  readonly recorder: RecorderState;
  /** null: nothing is being made. */
  readonly exporting: ExportState | null;
  readonly inSession: boolean;
  /** The session shows the room around the user. */
  readonly inPassthrough: boolean;
  /** The frame rate of the worn headset [Hz]; null: it does not report it, or none is worn. */
  readonly rateHz: number | null;
  /** The rates that it offers [Hz]. */
  readonly ratesHz: readonly number[];
  /** Whether the next session uses the headset's body tracking. */
  readonly deviceBody: boolean;
  /** Why the worn headset tracks no body; null: it does, or no headset is worn. */
  readonly bodyComplaint: string | null;
}

export interface BodyActions {
  chooseEstimator(name: EstimatorName): void;
  calibrate(): void;
  setMeasures(measures: Pick<PanelState, 'heightCm' | 'armSpanCm' | 'forearmCm'>): void;
  resetCalibration(): void;
  setDeviceBody(on: boolean): void;
}

export interface AvatarActions {
  choosePalette(name: string): void;
  chooseBuiltInBody(name: BuiltInBody): void;
  chooseSkinTone(tone: SkinTone): void;
  openAvatarFile(file: File): void;
  openAvatarUrl(url: string): void;
  showBuiltInAvatar(): void;
  cancelAvatar(): void;
  setUpperBodyOnly(on: boolean): void;
  /** Opens the form for the bones of the shown file. */
  correctBones(): void;
  /** Which bone of the file that waits is which; null: forgets the user's map. */
  giveBones(bones: BoneMap | null): void;
  setShareAvatar(on: boolean): void;
  setPlainOthers(on: boolean): void;
}

export interface RecordingActions {
  record(): void;
  stop(): void;
  replay(): void;
  download(): void;
  exportMotion(choice: ExportChoice): void;
  cancelExport(): void;
  /** Recordings, or the files of one motion. */
  openFiles(files: readonly File[]): void;
  /** Opens files that were chosen as motion capture, of a body that moves its motion. */
  openMotion(files: readonly File[]): void;
  seek(seconds: number): void;
  setPaused(on: boolean): void;
  setLoop(on: boolean): void;
  setActor(on: boolean): void;
  setEmulatorPanel(on: boolean): void;
}

export interface ViewActions {
  chooseView(view: ViewName): void;
  setMirror(on: boolean): void;
  setDebugSkeleton(on: boolean): void;
  setOverlay(on: boolean): void;
  setLargerText(on: boolean): void;
  setSingleKeys(on: boolean): void;
}

/** A page of the panel, behind its tab. It shows a state and reports wishes; what happens is decided elsewhere. */
export interface PanelPage {
  readonly name: string;
  readonly content: readonly Node[];
  show(state: PanelState): void;
}
