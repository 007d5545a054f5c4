import type { ChestSpaceBody } from '../body/skeleton';
import type { Transform } from '../math/pose';
import type { DeviceBody } from '../tracking/device-body';
import type { CompletedFrame } from './complete-hands';
import type { MutableJointPositions } from './joint-positions';
import type { IkSolution, ThreePoints } from './solve-ik';
import type { SteadyTrackersState } from './steady-trackers';

/** What the first two stages found of one frame. */
export interface SolvedFrame {
  /** [s] */
  readonly time: number;
  /** Floor frame. */
  readonly completed: CompletedFrame;
  /** What the joints are estimated from, floor frame. */
  readonly trackers: SteadyTrackersState;
  readonly floorFromHeading: Transform<'floor', 'heading'>;
  /** Head and hands of `trackers`, heading frame. */
  readonly points: ThreePoints;
  /** Heading frame. */
  readonly ik: IkSolution;
  /** null: the device reports none in this frame. */
  readonly deviceBody: DeviceBody | null;
}

/** Stage 3: where a method's six joints come from; every other stage is the same for all methods. One per wearer. */
export interface JointSource {
  calibrate(body: ChestSpaceBody): void;
  reset(): void;
  /** Writes the six joints [m], floor frame, finite; deltaSeconds since the last call, 0 at first. */
  joints(solved: SolvedFrame, deltaSeconds: number, target: MutableJointPositions): void;
  /** The network behind it; null: there is none. */
  readonly network: JointNetwork | null;
}

/** The network behind a joint source. */
export interface JointNetwork {
  /** Whether `ask` is to be called after each frame; false for a network that answers inside `joints`. */
  readonly wantsFrames: boolean;
  /** Asks about this frame, unless a question is open; resolves when that is answered, however it ends. Never rejects. */
  ask(solved: SolvedFrame): Promise<void>;
  /** The newest answer as joints [m], floor frame, moved along with this frame, before any filter; null before the first answer and after a fault. */
  answer(solved: SolvedFrame): MutableJointPositions | null;
  /** What went wrong last, until an answer comes; null: nothing. */
  readonly fault: string | null;
}
