import type { HapticPulse } from 'threepoint/core';
import { pulseBothHands } from 'threepoint-games';
import type { ArcheryEvent } from 'threepoint-games/archery';

/**
 * Returns the haptic pulses of events: a hit in the bow hand, stronger for more points, a warning and the bell in both
 * hands. The gestures return the pulses of draw and release.
 */
export function eventHaptics(events: readonly ArcheryEvent[], bowSide: HapticPulse['side']): readonly HapticPulse[] {
  return events.flatMap((event) => {
    if (event.type === 'landed' && event.landing.target !== null) {
      const strength = event.landing.points > 0 ? 0.25 + 0.5 * Math.min(1, event.landing.points / 20) : 0.15;
      return [{ side: bowSide, strength, seconds: 0.04 }];
    }
    if (event.type === 'left-zone') return pulseBothHands(0.6, 0.18);
    if (event.type === 'ended') return pulseBothHands(0.4, 0.3);
    return [];
  });
}
