import type { HapticPulse } from 'threepoint/core';

export const pulseBothHands = (strength: number, seconds: number): readonly HapticPulse[] => [
  { side: 'left', strength, seconds },
  { side: 'right', strength, seconds },
];
