import type { BallState } from 'threepoint-games/ball/ball-state';
import { ballSecondsLeft } from 'threepoint-games/ball/state-selectors';

/** The displayed clock of a match. After its end it stays at the time that was left. */
export function createDisplayedClock() {
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
