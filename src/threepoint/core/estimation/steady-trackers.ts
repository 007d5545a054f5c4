import { type FilteredPose, filterPose, makeFilteredPose } from '../math/one-euro';
import type { CompletedFrame } from './complete-hands';
import smoothing from './smoothing.json' with { type: 'json' };

const { trackers: tuning } = smoothing;

type Tracker = 'head' | 'leftHand' | 'rightHand';
const trackers: readonly Tracker[] = ['head', 'leftHand', 'rightHand'];

/** The filtered trackers that joints are estimated from, floor frame. Head and hands are drawn unfiltered. */
export type SteadyTrackersState = Readonly<Record<Tracker, FilteredPose<'floor'>>>;

export const makeSteadyTrackersState = (): SteadyTrackersState => ({
  head: makeFilteredPose(),
  leftHand: makeFilteredPose(),
  rightHand: makeFilteredPose(),
});

/** Filters the noise of the trackers for the estimate of joints: strongly at rest, hardly in motion. */
export function steadyTrackers(
  state: SteadyTrackersState,
  completed: CompletedFrame,
  deltaSeconds: number,
): SteadyTrackersState {
  for (let index = 0; index < trackers.length; index++) {
    const tracker = trackers[index]!;
    filterPose(state[tracker], completed[tracker], tuning, deltaSeconds);
  }
  return state;
}

export function resetSteadyTrackers(state: SteadyTrackersState): void {
  for (const tracker of trackers) state[tracker].known = false;
}
