import { type HandTilts, turnOfTilt, turnToForearm, usualHandTilt } from '../body/hand-tilt';
import { type MutableQuat, quat, rotate } from '../math/quat';
import { type Side, sides } from '../math/side';
import { addScaled, copyVec3, forward, lerp, type MutableVec3, normalise, scale, vec3 } from '../math/vec3';
import type { CompletedFrame } from './complete-hands';
import { memorySeconds, toldSeconds, usualSeconds } from './hand-tilts.json';
import type { IkSolution } from './solve-ik';

/** What is known of how one hand stands to its forearm; directions from elbow to wrist in the frame of the hand as it is tracked. */
interface HandTiltState {
  /** The direction that calibration tells, or the usual one; as long as the motion that it counts for [s]. */
  readonly prior: MutableVec3;
  /** The prior and every direction noticed since, each as long as it was seen [s] and forgotten by and by. */
  readonly sum: MutableVec3;
}

export interface HandTiltsState {
  readonly left: HandTiltState;
  readonly right: HandTiltState;
  /** What each hand is turned by in its own frame so that its −Z continues the forearm. */
  readonly turns: Readonly<Record<Side, MutableQuat>>;
}

const makeHandTiltState = (): HandTiltState => ({ prior: vec3(0, 0, 0), sum: vec3(0, 0, 0) });

/** Of a wearer of whom this is told. */
export function makeHandTiltsState(told: HandTilts | undefined): HandTiltsState {
  const state: HandTiltsState = {
    left: makeHandTiltState(),
    right: makeHandTiltState(),
    turns: { left: quat(0, 0, 0, 1), right: quat(0, 0, 0, 1) },
  };
  tellHandTilts(state, told);
  return state;
}

/**
 * Takes what another calibration tells, and begins anew from it. Nothing else makes hands forgotten: after a recentre or a pause they are held
 * as before.
 */
export function tellHandTilts(state: HandTiltsState, told: HandTilts | undefined): void {
  for (const side of sides) {
    const { prior, sum } = state[side];
    const tilt = told?.[side];
    rotate(turnOfTilt(tilt ?? usualHandTilt(side)), forward, prior);
    scale(prior, tilt ? toldSeconds : usualSeconds, prior);
    copyVec3(prior, sum);
    turnAfter(state, side);
  }
}

const direction = vec3(0, 0, 0);

function turnAfter(state: HandTiltsState, side: Side): void {
  turnToForearm(normalise(state[side].sum, forward, direction), state.turns[side]);
}

/**
 * Notices where the forearms of hands that are seen point in the frames of those hands, for the frames to come. Inverse kinematics tells it from
 * where hands and head are and, little, from how the hands are turned; its errors go as the posture changes, the tilt stays.
 * It is told nothing of the tilts themselves, so that no error can feed itself.
 */
export function noticeHandTilts(
  state: HandTiltsState,
  { untoldForearms }: IkSolution,
  { leftHand, rightHand }: Pick<CompletedFrame, 'leftHand' | 'rightHand'>,
  deltaSeconds: number,
): void {
  if (deltaSeconds <= 0) return;
  const kept = Math.exp(-deltaSeconds / memorySeconds);
  for (const side of sides) {
    const hand = side === 'left' ? leftHand : rightHand;
    if (hand.source !== 'tracked') continue;
    const { prior, sum } = state[side];
    lerp(prior, sum, kept, sum);
    addScaled(sum, untoldForearms[side], deltaSeconds, sum);
    turnAfter(state, side);
  }
}
