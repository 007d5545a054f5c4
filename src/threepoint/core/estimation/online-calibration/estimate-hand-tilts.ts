import { defaultHandTilt, forearmRotation, type HandTilts, tiltRotation } from '../../body/hand-tilt';
import { type MutableQuat, quat, rotate } from '../../math/quat';
import { type Side, sides } from '../../math/side';
import {
  addScaled,
  cross,
  dot,
  forward,
  length,
  type MutableVec3,
  normalise,
  scale,
  setVec3,
  vec3,
} from '../../math/vec3';
import type { CompletedFrame } from '../complete-hands';
import type { IkSolution } from '../ik/solve-ik';
import handTilts from './hand-tilts.json' with { type: 'json' };

const { calibratedMetres, doubtAngle, memoryMetres, usualMetres } = handTilts;

/** The estimated tilt of one hand to its forearm; directions from elbow to wrist in the frame of the tracked hand. */
interface HandTiltState {
  /** The calibrated direction, or the default one, unit. */
  readonly prior: MutableVec3;
  calibrated: boolean;
  /** Sum of observed directions times metres of travel [m], decaying by 1/e in memoryMetres. */
  readonly observed: MutableVec3;
}

export interface HandTiltsState {
  readonly left: HandTiltState;
  readonly right: HandTiltState;
  /** The rotation of each hand in its own frame after which its −Z continues the forearm. */
  readonly turns: Readonly<Record<Side, MutableQuat>>;
}

const makeHandTiltState = (): HandTiltState => ({ prior: vec3(0, 0, 0), calibrated: false, observed: vec3(0, 0, 0) });

/** Returns the state for a user with these calibrated tilts. */
export function makeHandTiltsState(calibrated: HandTilts | undefined): HandTiltsState {
  const state: HandTiltsState = {
    left: makeHandTiltState(),
    right: makeHandTiltState(),
    turns: { left: quat(0, 0, 0, 1), right: quat(0, 0, 0, 1) },
  };
  resetHandTilts(state, calibrated);
  return state;
}

/**
 * Resets the estimate to the tilts of another calibration. A recentring or a pause does not reset it, because the hands
 * hold the controllers as before.
 */
export function resetHandTilts(state: HandTiltsState, calibrated: HandTilts | undefined): void {
  for (const side of sides) {
    const hand = state[side];
    const tilt = calibrated?.[side];
    rotate(tiltRotation(tilt ?? defaultHandTilt(side)), forward, hand.prior);
    hand.calibrated = tilt !== undefined;
    setVec3(hand.observed, 0, 0, 0);
    turnAfter(state, side);
  }
}

const direction = vec3(0, 0, 0);

/**
 * Weight of the prior, as the metres of observed travel it equals. A measured tilt's shrinks with the square of
 * doubtAngle/angle once prior and observations differ by more than doubtAngle; the usual tilt's is constant.
 */
function priorMetres({ prior, calibrated, observed }: HandTiltState): number {
  if (!calibrated) return usualMetres;
  const angle = Math.atan2(length(cross(prior, observed, direction)), dot(prior, observed));
  return angle > doubtAngle ? calibratedMetres * (doubtAngle / angle) ** 2 : calibratedMetres;
}

function turnAfter(state: HandTiltsState, side: Side): void {
  const hand = state[side];
  addScaled(hand.observed, hand.prior, priorMetres(hand), direction);
  forearmRotation(normalise(direction, forward, direction), state.turns[side]);
}

/**
 * Accumulates, per tracked hand, the forearm direction that IK gives without knowledge of tilts (frame of the hand as
 * it is tracked), weighted by how far the hand has travelled about the head since the frame before. Takes effect next
 * frame. The input ignores the estimate, so errors cannot feed back; IK's own errors average out as the posture
 * changes. A hand at rest changes nothing.
 */
export function estimateHandTilts(
  state: HandTiltsState,
  { untiltedForearms }: IkSolution,
  { leftHand, rightHand }: Pick<CompletedFrame, 'leftHand' | 'rightHand'>,
  travel: Readonly<Record<Side, number>>,
): void {
  for (const side of sides) {
    const hand = side === 'left' ? leftHand : rightHand;
    const metres = travel[side];
    if (hand.source !== 'tracked' || metres === 0) continue;
    const { observed } = state[side];
    addScaled(scale(observed, Math.exp(-metres / memoryMetres), observed), untiltedForearms[side], metres, observed);
    turnAfter(state, side);
  }
}
