import type { Calibration } from 'threepoint/core';
import type { Side } from 'threepoint/math';
import type { Embodiment } from '../../model/plan/embodiment';
import type { DeviceProblem } from '../../model/plan/remote-setup';
import type { TrialHost } from './study-trial';
import type { TaskRunner } from './task-runner';

/** The interface of the page that the study needs. */
export interface StudyHost extends TrialHost {
  /** The games that this page can play as tasks, by their names in plans. */
  readonly runners: Readonly<Partial<Record<string, TaskRunner>>>;
  enterVr(): Promise<void>;
  /** Returns why no headset can be worn on this device, or null. */
  deviceProblem(): DeviceProblem | null;
  /** Returns the room within the headset's boundary [m], or null if it is not reported or no headset is worn. */
  room(): { readonly width: number; readonly depth: number } | null;
  inSession(): boolean;
  /**
   * Sets the calibration of this participant for this visit only. null: not measured yet; the calibration of another
   * person is discarded.
   */
  setCalibration(calibration: Calibration | null): void;
  /**
   * Gives the participant a body; resolves when it is drawn, rejects with a sentence. `seed` decides its random parts.
   */
  embody(embodiment: Embodiment, seed: number): Promise<void>;
  setActor(on: boolean): void;
  setBowSide(side: Side): void;
}
