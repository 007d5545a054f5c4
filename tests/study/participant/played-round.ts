import { defaultCalibration } from 'threepoint/core';
import { ArcheryPlay } from '../../../src/page/archery/archery-play';
import { createArcheryRunner } from '../../../src/page/archery/archery-runner';
import { type FinishedTrial, PlayedTrial } from '../../../src/study/participant/trial/study-trial';
import { activityServices } from '../../page/activity-services';

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

/** The built-in archer, and what a study makes them play. */
export function studiedArcher(seed: number) {
  const play = new ArcheryPlay(
    defaultCalibration,
    () => ({ bowSide: 'left', oneHanded: false, everyHitCounts: false, startSignal: true }),
    () => seed,
  );
  const archery = {
    play,
    startRound() {
      play.restart(defaultCalibration);
      play.signal();
    },
    resetRound: () => undefined,
  };
  const { settings, writer } = activityServices();
  const runner = createArcheryRunner({
    settings,
    writer,
    opened: () => archery,
    open: async () => archery,
    leave: () => undefined,
  });
  return { play, runner };
}

/**
 * The built-in archer's round in a study, begun at `began` by the page's clock, and when by it each arrow came down.
 */
export function playedRound({ paused = never, headless = never, handless = never }: RoundTroubles, began = 345.6) {
  const { play, runner } = studiedArcher(3);
  let time = began;
  const step = {
    kind: 'trial',
    id: 'archery/1/trial-1',
    embodiment: { estimator: 'ik' },
    seconds: 70,
  } as ConstructorParameters<typeof PlayedTrial>[0];
  const trial = new PlayedTrial(
    step,
    runner,
    {
      calibration: () => defaultCalibration,
      device: () => ({ name: 'Test headset', refreshRateHz: 72, input: 'controllers' }),
      estimator: () => 'ik',
      listenToFrames: () => undefined,
    },
    { key: 'archery/1/trial-1@1.1', motion: true, seed: 3, now: () => epoch + time },
  );
  const landed: number[] = [];
  let finished: FinishedTrial | null = null;
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
