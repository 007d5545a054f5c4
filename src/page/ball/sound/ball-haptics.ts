import type { BallEvent, BallRole } from 'threepoint-games/ball/ball-state';
import type { BallPulse } from 'threepoint-games/ball/gestures';

/**
 * Haptic pulses of events away from the user's hands. The holder feels a catch in both hands, the thrower lightly; the
 * rim gives a knock; all feel start and bell. The gestures give the pulses of grabbing and throwing.
 */
export function eventHaptics(events: readonly BallEvent[], me: number, role: BallRole): readonly BallPulse[] {
  const both = (strength: number, seconds: number): BallPulse[] => [
    { side: 'left', strength, seconds },
    { side: 'right', strength, seconds },
  ];
  return events.flatMap((event) => {
    switch (event.type) {
      case 'started':
        return both(0.35, 0.12);
      case 'ended':
        return both(0.4, 0.3);
      case 'caught':
        if (role === 'holder') return both(0.75, 0.07);
        return event.player === me ? both(0.25, 0.05) : [];
      case 'bounced':
        return event.off === 'basket' && role === 'holder' ? both(0.4, 0.03) : [];
      case 'refused':
        return event.player === me && event.reason !== 'seen-before' ? both(0.2, 0.03) : [];
      default:
        return [];
    }
  });
}
