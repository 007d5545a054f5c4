import { defaultCalibration } from 'threepoint/core';
import { createArcheryRunner } from '../../../src/page/archery/archery-runner';
import { activityServices } from '../activity-services';
import { archeryPage } from '../playing';

/** The built-in archer, and what a study makes them play. */
export function studiedArcher(seed: number) {
  const play = archeryPage({ startSignal: true }, () => seed);
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
