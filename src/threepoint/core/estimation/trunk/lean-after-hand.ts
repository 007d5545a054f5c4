import { softenedReach } from '../../body/two-bone-ik';
import {
  addScaled,
  copyVec3,
  distance,
  length,
  lerp,
  type MutableVec3,
  normalise,
  scale,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from '../../math/vec3';
import type { CompletedHand } from '../complete-hands';
import limits from '../kinematic-limits.json' with { type: 'json' };

const { anatomicalPasses, extremeReach } = limits.reach;

/** The highest speed of a lean [m/s], towards a reacquired hand or back after a lost one. */
const leanSpeed = 0.6;

/**
 * Offset of a shoulder's target [m, floor frame], from the estimated shoulder towards a hand that is out of reach, or
 * reachable only with a nearly straight arm.
 */
export interface Lean {
  /** The offset that reaches the hand in this frame, and in the previous one. */
  readonly wanted: MutableVec3;
  readonly wantedBefore: MutableVec3;
  /** The offset in use, limited in speed. */
  readonly offset: MutableVec3;
  /** The target distance of shoulder and hand within anatomical limits [m]. */
  softReach: number;
  /** How far clavicle and neck exceed their anatomical limits [fraction of the range to their extremes, 0 to 1]. */
  extremity: number;
  /** Its value in the frame before. */
  extremityBefore: number;
}

export const makeLean = (): Lean => ({
  wanted: vec3(0, 0, 0),
  wantedBefore: vec3(0, 0, 0),
  offset: vec3(0, 0, 0),
  softReach: Number.NaN,
  extremity: 0,
  extremityBefore: 0,
});

const towards = vec3(0, 0, 0);

export function startLeanFrame(lean: Lean): void {
  setVec3(lean.wanted, 0, 0, 0);
  lean.extremity = 0;
}

/**
 * Adds to the lean until the wrist distance is the soft reach (first `anatomicalPasses`) or the full reach (later
 * passes, which also raise `extremity`), within one arm's reach. Returns false when nothing is missing, or the hand is
 * sinking.
 *
 * `reach`: the arm's [m]; `pass`: the number of earlier passes in this frame.
 */
export function increaseLean(
  lean: Lean,
  shoulder: Vec3,
  { position, source }: CompletedHand,
  reach: number,
  pass: number,
): boolean {
  if (source === 'sinking') return false;
  const far = length(subtract(position, shoulder, towards));
  if (pass === 0) lean.softReach = softenedReach(far, reach);
  const missing = far - (pass < anatomicalPasses ? lean.softReach : reach);
  if (missing <= 1e-5) return false;
  if (pass >= anatomicalPasses) lean.extremity = Math.min(1, lean.extremity + missing / (extremeReach * reach));
  addScaled(lean.wanted, normalise(towards, undefined, towards), missing, lean.wanted);
  const leant = length(lean.wanted);
  if (leant > reach) scale(lean.wanted, reach / leant, lean.wanted);
  return true;
}

/**
 * Follows `wanted` at no more than leanSpeed, and with it the limits of clavicle and neck; for a fully confident
 * tracked hand this frame's change of `wanted` is applied at once, and in the first frame (not `known`) all of it.
 * Returns whether `wanted` was reached.
 */
export function followLean(lean: Lean, hand: CompletedHand, known: boolean, deltaSeconds: number): boolean {
  const { wanted, wantedBefore, offset } = lean;
  const anew = hand.source === 'tracked' && hand.confidence === 1 ? distance(wanted, wantedBefore) : 0;
  const most = known ? leanSpeed * Math.max(deltaSeconds, 0) + anew : Number.POSITIVE_INFINITY;
  copyVec3(wanted, wantedBefore);
  const isReached = distance(wanted, offset) <= most;
  if (isReached) copyVec3(wanted, offset);
  else {
    const leant = length(offset);
    lerp(offset, wanted, most / distance(wanted, offset), offset);
    const left = leant > 0 ? Math.min(1, length(offset) / leant) : 0;
    lean.extremity = Math.max(lean.extremity, left * lean.extremityBefore);
  }
  lean.extremityBefore = lean.extremity;
  return isReached;
}
