import type { BallEvent, BallRole } from 'threepoint-games/ball/ball-state';
import type { BallPulse } from 'threepoint-games/ball/gestures';

/**
 * Pulses of what happens away from one's own hands: a catch is felt in the basket with both hands, and lightly by the thrower; the
 * rim gives a knock; start and bell are felt by all. Taking and throwing are the gestures' own.
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
