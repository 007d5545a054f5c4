import { defaultHandTilt, forearmRotation, type HandTilts, tiltRotation } from '../../body/hand-tilt';
import { smoothingFactor } from '../../math/damper';
import { type MutableQuat, type Quat, quat, rotate } from '../../math/quat';
import { type Side, sides } from '../../math/side';
import { addScaled, forward, lerp, type MutableVec3, normalise, setVec3, type Vec3, vec3 } from '../../math/vec3';
import handTilts from './hand-tilts.json' with { type: 'json' };

const { calibratedWeight, halfLife, usualWeight } = handTilts;

/** The estimated tilt of one hand to its forearm; directions from elbow to wrist in the frame of the tracked hand. */
interface HandTiltState {
  /** The calibrated direction, or the default one, unit. */
  readonly prior: MutableVec3;
  /** The weight of the prior; that of the observed direction is 1. */
  priorWeight: number;
  /** The low-passed direction that IK gives without the tilt; zero before the hand is seen. */
  readonly observed: MutableVec3;
  known: boolean;
}

export interface HandTiltsState extends Readonly<Record<Side, HandTiltState>> {
  /** The rotation of each hand in its own frame after which its −Z continues the forearm. */
  readonly turns: Readonly<Record<Side, MutableQuat>>;
}

const makeHandTiltState = (): HandTiltState => ({
  prior: vec3(0, 0, 0),
  priorWeight: Number.NaN,
  observed: vec3(0, 0, 0),
  known: false,
});

/** Returns the state for a user with these calibrated tilts. */
export function makeHandTiltsState(calibrated: HandTilts | undefined): HandTiltsState {
  const state: HandTiltsState = {
    left: makeHandTiltState(),
    right: makeHandTiltState(),
    turns: { left: quat(0, 0, 0, 1), right: quat(0, 0, 0, 1) },
  };
  calibrateHandTilts(state, calibrated);
  return state;
}

/** Resets the estimate to the tilts of another calibration. */
export function calibrateHandTilts(state: HandTiltsState, calibrated: HandTilts | undefined): void {
  for (const side of sides) {
    const tilt = calibrated?.[side];
    rotate(tiltRotation(tilt ?? defaultHandTilt(side)), forward, state[side].prior);
    state[side].priorWeight = tilt ? calibratedWeight : usualWeight;
  }
  resetHandTilts(state);
}

/** Resets the estimate to the calibrated or default tilts. */
export function resetHandTilts(state: HandTiltsState): void {
  for (const side of sides) {
    setVec3(state[side].observed, 0, 0, 0);
    state[side].known = false;
    writeTurn(state, side);
  }
}

const direction = vec3(0, 0, 0);

function writeTurn(state: HandTiltsState, side: Side): void {
  const { observed, prior, priorWeight } = state[side];
  addScaled(observed, prior, priorWeight, direction);
  forearmRotation(normalise(direction, forward, direction), state.turns[side]);
}

/**
 * Low-passes the forearm direction of a tracked hand, as IK gives it without knowledge of tilts (unit, frame of the
 * tracked hand), and returns the hand's rotation. The input ignores the estimate, so errors cannot feed back. The
 * memory lasts seconds: a hand at rest has the same tilt wherever it came from.
 */
export function estimateHandTilt(state: HandTiltsState, side: Side, forearm: Vec3, deltaSeconds: number): Quat {
  const hand = state[side];
  lerp(hand.observed, forearm, hand.known ? smoothingFactor(halfLife, deltaSeconds) : 1, hand.observed);
  hand.known = true;
  writeTurn(state, side);
  return state.turns[side];
}
