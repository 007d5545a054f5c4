import { clamp } from '../../math/damper';
import { type Side, sides } from '../../math/side';
import { length, subtract, vec3 } from '../../math/vec3';
import type { CompletedFrame } from '../complete-hands';
import type { SolvedFrame } from '../joint-source';
import headsetRise from './headset-rise.json' with { type: 'json' };

const { furthest, hanging, share: fraction, speed, unremarkable, usualReach } = headsetRise;

/** The estimate of the headset's rise above its nominal position on the head. */
export interface HeadsetRiseState {
  /** Tracked quantile of the shoulder–wrist distance while the arm hangs [arm lengths]. */
  readonly reach: Record<Side, number>;
  /** [m] */
  rise: number;
}

export const makeHeadsetRiseState = (): HeadsetRiseState => ({
  reach: { left: usualReach, right: usualReach },
  rise: 0,
});

/** Resets the estimate for another calibration. */
export function resetHeadsetRise(state: HeadsetRiseState): void {
  state.reach.left = usualReach;
  state.reach.right = usualReach;
  state.rise = 0;
}

interface ObservedFrame extends Pick<SolvedFrame, 'points' | 'ik'> {
  readonly completed: Pick<CompletedFrame, 'leftHand' | 'rightHand'>;
}

const fromShoulder = vec3(0, 0, 0);

/**
 * Estimates how far the headset sits above its nominal place [m], which carries IK's shoulders up with it. While an arm
 * hangs, a quantile of the shoulder–wrist distance is tracked (stochastic approximation: Robbins and Monro, Annals of
 * Mathematical Statistics 22(3), 1951); the mean of both arms less usualReach, less a dead zone for anatomical
 * variation, is attributed to the headset, within ±furthest.
 *
 * `arm`: its length [m]; `lowered`: the rise by which the head of this frame was already lowered [m].
 */
export function estimateHeadsetRise(
  state: HeadsetRiseState,
  { completed, points, ik: { joints } }: ObservedFrame,
  arm: number,
  lowered: number,
  deltaSeconds: number,
): void {
  for (const side of sides) {
    const left = side === 'left';
    if ((left ? completed.leftHand : completed.rightHand).source !== 'tracked') continue;
    const wrist = (left ? points.leftHand : points.rightHand).position;
    subtract(wrist, left ? joints.leftUpperArm : joints.rightUpperArm, fromShoulder);
    fromShoulder.y -= lowered;
    const far = length(fromShoulder);
    if (-fromShoulder.y <= hanging * far) continue;
    const { reach } = state;
    reach[side] += speed * deltaSeconds * (far > reach[side] * arm ? fraction : fraction - 1);
  }
  const further = (state.reach.left + state.reach.right) / 2 - usualReach;
  const beyond = further - clamp(further, -unremarkable, unremarkable);
  state.rise = clamp(arm * beyond, -furthest, furthest);
}
