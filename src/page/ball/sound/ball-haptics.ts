import type { BallEvent, BallRole } from 'threepoint-games/ball/ball-state';
import { type HapticPulse, inBothHands } from 'threepoint-games/haptic-pulse';

/**
 * Haptic pulses of events away from the user's hands. The holder feels a catch in both hands, the thrower lightly; the
 * rim gives a knock; all feel start and bell. The gestures give the pulses of grabbing and throwing.
 */
export function eventHaptics(events: readonly BallEvent[], me: number, role: BallRole): readonly HapticPulse[] {
  return events.flatMap((event) => {
    switch (event.type) {
      case 'started':
        return inBothHands(0.35, 0.12);
      case 'ended':
        return inBothHands(0.4, 0.3);
      case 'caught':
        if (role === 'holder') return inBothHands(0.75, 0.07);
        return event.player === me ? inBothHands(0.25, 0.05) : [];
      case 'bounced':
        return event.off === 'basket' && role === 'holder' ? inBothHands(0.4, 0.03) : [];
      case 'refused':
        return event.player === me && event.reason !== 'seen-before' ? inBothHands(0.2, 0.03) : [];
      default:
        return [];
    }
  });
}
