import type { Calibration } from 'threepoint/core/body/calibration';
import type { Side } from 'threepoint/core/math/side';
import type { Embodiment } from '../model/plan/embodiment';
import type { DeviceFault } from '../model/plan/remote-setup';
import type { TrialHost } from './study-trial';
import type { TaskRunner } from './task-runner';

/** What the study needs of the page; the page decides how. */
export interface StudyHost extends TrialHost {
  /** The games this page can play as tasks, by the name that plans call them. */
  readonly runners: Readonly<Partial<Record<string, TaskRunner>>>;
  enterVr(): Promise<void>;
  /** Why no headset can be worn on this device; null: one can. */
  deviceFault(): DeviceFault | null;
  /** The room that the headset's boundary leaves [m]; null: it does not tell, or is not worn. */
  room(): { readonly width: number; readonly depth: number } | null;
  inSession(): boolean;
  /** Of this participant, for this visit; not remembered for others. null: not measured yet, and what the page had is another person's. */
  setCalibration(calibration: Calibration | null): void;
  /** Gives the participant this body; resolves when it is drawn, rejects with a sentence. `seed`: of what is random in it. */
  embody(embodiment: Embodiment, seed: number): Promise<void>;
  setActor(on: boolean): void;
  setBowSide(side: Side): void;
}
