import type { BallState } from 'threepoint-games/ball/ball-state';
import { ballSecondsLeft } from 'threepoint-games/ball/state-readings';

/** The clock of matches as it is shown: after the end of one it stands at what was left. */
export function createMatchClock() {
  let secondsLeft = 0;
  return {
    /** Until the bell [s]. */
    get secondsLeft() {
      return secondsLeft;
    },
    /** Every frame of a match. */
    follow(state: BallState): void {
      if (state.phase !== 'over') secondsLeft = ballSecondsLeft(state);
      else if (state.end === 'time') secondsLeft = 0;
    },
  };
}
