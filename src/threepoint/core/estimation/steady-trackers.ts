import {
  makeSteadyOrientation,
  makeSteadyPoint,
  type SteadyOrientation,
  type SteadyPoint,
  steadyOrientation,
  steadyPoint,
} from '../math/one-euro';
import type { Pose } from '../math/pose';
import { type Side, sides } from '../math/side';
import { copyVec3, distance, type MutableVec3, subtract, vec3 } from '../math/vec3';
import type { CompletedFrame } from './complete-hands';
import { points, turns } from './smoothing.json';

type Tracker = 'head' | 'leftHand' | 'rightHand';
const trackers: readonly Tracker[] = ['head', 'leftHand', 'rightHand'];

interface TrackerState {
  readonly position: SteadyPoint;
  readonly orientation: SteadyOrientation;
  /** The filtered pose. */
  readonly pose: Pose<'floor'>;
}

/** The filtered trackers that joints are estimated from, floor frame. Head and hands are drawn unfiltered. */
export type SteadyTrackersState = Readonly<Record<Tracker, TrackerState>> & {
  /** The distance that each hand has moved about the head since the frame before [m], floor axes; 0 in the first. */
  readonly travel: Record<Side, number>;
  /** Each hand from the head [m], floor axes. */
  readonly fromHead: Readonly<Record<Side, MutableVec3>>;
};

function makeTracker(): TrackerState {
  const position = makeSteadyPoint();
  const orientation = makeSteadyOrientation();
  return { position, orientation, pose: { position: position.value, orientation: orientation.value } };
}

export const makeSteadyTrackersState = (): SteadyTrackersState => ({
  head: makeTracker(),
  leftHand: makeTracker(),
  rightHand: makeTracker(),
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
  const { known } = state.head.position;
  for (let index = 0; index < trackers.length; index++) {
    const tracker = trackers[index]!;
    const { position, orientation } = state[tracker];
    steadyPoint(position, completed[tracker].position, points, deltaSeconds);
    steadyOrientation(orientation, completed[tracker].orientation, turns, deltaSeconds);
  }
  for (const side of sides) {
    const hand = side === 'left' ? state.leftHand : state.rightHand;
    subtract(hand.pose.position, state.head.pose.position, fromHead);
    state.travel[side] = known ? distance(fromHead, state.fromHead[side]) : 0;
    copyVec3(fromHead, state.fromHead[side]);
  }
  return state;
}

/** Resets the filters: the next frame is the first. */
export function resetSteadyTrackers(state: SteadyTrackersState): void {
  for (const tracker of trackers) {
    state[tracker].position.known = false;
    state[tracker].orientation.known = false;
  }
}
