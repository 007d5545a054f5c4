import type { Side } from 'threepoint/core/math/side';

/** A haptic pulse for one hand. */
export interface HapticPulse {
  readonly side: Side;
  /** 0 to 1. */
  readonly strength: number;
  readonly seconds: number;
}

/** Returns the same pulse for both hands. */
export const inBothHands = (strength: number, seconds: number): readonly HapticPulse[] => [
  { side: 'left', strength, seconds },
  { side: 'right', strength, seconds },
];
