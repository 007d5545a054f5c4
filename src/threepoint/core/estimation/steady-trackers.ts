import { type FilteredPose, filterPose, makeFilteredPose } from '../math/one-euro';
import { type Side, sides } from '../math/side';
import { copyVec3, distance, type MutableVec3, subtract, vec3 } from '../math/vec3';
import type { CompletedFrame } from './complete-hands';
import smoothing from './smoothing.json' with { type: 'json' };

const { trackers: tuning } = smoothing;

type Tracker = 'head' | 'leftHand' | 'rightHand';
const trackers: readonly Tracker[] = ['head', 'leftHand', 'rightHand'];

/** The filtered trackers that joints are estimated from, floor frame. Head and hands are drawn unfiltered. */
export type SteadyTrackersState = Readonly<Record<Tracker, FilteredPose<'floor'>>> & {
  /** The path of each hand relative to the head since the previous frame [m], floor axes; 0 in the first frame. */
  readonly travel: Record<Side, number>;
  /** Each hand from the head [m], floor axes. */
  readonly fromHead: Readonly<Record<Side, MutableVec3>>;
};

export const makeSteadyTrackersState = (): SteadyTrackersState => ({
  head: makeFilteredPose(),
  leftHand: makeFilteredPose(),
  rightHand: makeFilteredPose(),
  travel: { left: 0, right: 0 },
  fromHead: { left: vec3(0, 0, 0), right: vec3(0, 0, 0) },
});

const fromHead = vec3(0, 0, 0);

/** Filters the noise of the trackers for the estimate of joints: strongly at rest, hardly in motion. */
export function steadyTrackers(
  state: SteadyTrackersState,
  completed: CompletedFrame,
  deltaSeconds: number,
): SteadyTrackersState {
  const { known } = state.head;
  for (let index = 0; index < trackers.length; index++) {
    const tracker = trackers[index]!;
    filterPose(state[tracker], completed[tracker], tuning, deltaSeconds);
  }
  for (const side of sides) {
    const hand = side === 'left' ? state.leftHand : state.rightHand;
    subtract(hand.value.position, state.head.value.position, fromHead);
    state.travel[side] = known ? distance(fromHead, state.fromHead[side]) : 0;
    copyVec3(fromHead, state.fromHead[side]);
  }
  return state;
}

export function resetSteadyTrackers(state: SteadyTrackersState): void {
  for (const tracker of trackers) state[tracker].known = false;
}
