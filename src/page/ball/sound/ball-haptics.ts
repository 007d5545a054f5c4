import type { HapticPulse } from 'threepoint/core';
import { pulseBothHands } from 'threepoint-games';
import type { BallEvent, BallRole } from 'threepoint-games/ball';

/**
 * Haptic pulses of events away from the user's hands. The holder feels a catch in both hands, the thrower lightly; the
 * rim gives a knock; all feel start and bell. The gestures give the pulses of grabbing and throwing.
 */
export function eventHaptics(events: readonly BallEvent[], me: number, role: BallRole): readonly HapticPulse[] {
  return events.flatMap((event) => {
    switch (event.type) {
      case 'started':
        return pulseBothHands(0.35, 0.12);
      case 'ended':
        return pulseBothHands(0.4, 0.3);
      case 'caught':
        if (role === 'holder') return pulseBothHands(0.75, 0.07);
        return event.player === me ? pulseBothHands(0.25, 0.05) : [];
      case 'bounced':
        return event.off === 'basket' && role === 'holder' ? pulseBothHands(0.4, 0.03) : [];
      case 'refused':
        return event.player === me && event.reason !== 'seen-before' ? pulseBothHands(0.2, 0.03) : [];
      default:
        return [];
    }
  });
}
