import { studiedArcher } from '../../page/archery/studied-archer';
import { trialOf } from './played-trial';

export const frameSeconds = 1 / 72;
export const epoch = 1_800_000_000;

/**
 * What goes wrong in a round: at which second of it (by the page's clock) it is paused, the head or the left hand is
 * not seen.
 */
export interface RoundTroubles {
  readonly paused?: (second: number) => boolean;
  readonly headless?: (second: number) => boolean;
  readonly handless?: (second: number) => boolean;
}

const never = () => false;

/**
 * The built-in archer's round in a study, begun at `began` by the page's clock, and when by it each arrow came down.
 */
export function playedRound({ paused = never, headless = never, handless = never }: RoundTroubles, began = 345.6) {
  const { play, runner } = studiedArcher(3);
  let time = began;
  const trial = trialOf(runner, { seconds: 70, now: () => epoch + time });
  const landed: number[] = [];
  let finished: ReturnType<typeof trial.follow> = null;
  while (!finished && time < 600) {
    const stands = paused(time - began);
    const seen = !headless(time - began);
    const acted = play.act(time);
    const { buttons } = acted;
    const frame = handless(time - began) ? { ...acted.frame, leftHand: null } : acted.frame;
    trial.pause(stands);
    if (seen && !stands) {
      const shown = play.follow(frame, buttons);
      for (const event of shown.events) if (event.type === 'landed') landed.push(time);
      runner.played();
    }
    finished = trial.follow(time, seen ? frame : null);
    time += frameSeconds;
  }
  if (!finished) throw new Error('the round did not end');
  return { ...finished, landed, began };
}
