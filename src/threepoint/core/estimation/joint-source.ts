import type { ChestSpaceBody } from '../body/skeleton';
import type { Transform } from '../math/pose';
import type { DeviceBody } from '../tracking/device-body';
import type { CompletedFrame } from './complete-hands';
import type { IkSolution, ThreePoints } from './ik/solve-ik';
import type { MutableJointPositions } from './joint-positions';
import type { SteadyTrackersState } from './steady-trackers';

/** The results of the first two stages for one frame. */
export interface SolvedFrame {
  /** [s] */
  readonly time: number;
  /** Floor frame. */
  readonly completed: CompletedFrame;
  /** The filtered trackers that joints are estimated from, floor frame. */
  readonly trackers: SteadyTrackersState;
  readonly floorFromHeading: Transform<'floor', 'heading'>;
  /** Head and hands of `trackers`, heading frame. */
  readonly points: ThreePoints;
  /** Heading frame. */
  readonly ik: IkSolution;
  /** The device's own body; null: not reported in this frame. */
  readonly deviceBody: DeviceBody | null;
}

/** The source of a method's six joints (stage 3); all other stages are the same for every method. One per user. */
export interface JointSource {
  calibrate(body: ChestSpaceBody): void;
  reset(): void;
  /** Writes the six joints [m], floor frame, finite. `deltaSeconds`: the time since the last call, 0 at first. */
  joints(solved: SolvedFrame, deltaSeconds: number, target: MutableJointPositions): void;
  /** The network of this source; null: there is none. */
  readonly network: JointNetwork | null;
}

/** The network behind a joint source. */
export interface JointNetwork {
  /** Whether `ask` must be called after each frame; false for a network that answers within `joints`. */
  readonly wantsFrames: boolean;
  /** Requests an answer for this frame, unless a request is pending; resolves when that has settled. Never rejects. */
  ask(solved: SolvedFrame): Promise<void>;
  /**
   * Returns the newest answer as joints [m], floor frame, moved along with this frame and unfiltered; null before the
   * first answer and after a fault.
   */
  answer(solved: SolvedFrame): MutableJointPositions | null;
  /** The newest fault, until an answer arrives; null: there is none. */
  readonly fault: string | null;
}
