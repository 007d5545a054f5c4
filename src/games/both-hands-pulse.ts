import type { HapticPulse } from 'threepoint/core';

/** Returns the same pulse for both hands. */
export const pulseBothHands = (strength: number, seconds: number): readonly HapticPulse[] => [
  { side: 'left', strength, seconds },
  { side: 'right', strength, seconds },
];
