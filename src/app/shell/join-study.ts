import type { Calibration } from '../../core/body/calibration';
import type { EstimatorChoice } from '../../lib/estimator-choice';
import type { Activities, JoinedStudy } from './activities';
import type { FrameTiming } from './frame-timing';
import type { Headset } from './headset';
import type { Settings } from './settings';
import { createArcheryRunner } from './study-archery';
import { createBallRunner } from './study-ball';
import type { Switches } from './switches';

/** Characters of the device's name that a record keeps. */
const longestDeviceName = 160;

export interface JoinStudyOptions {
  readonly asked: NonNullable<Switches['study']>;
  readonly switches: Pick<Switches, 'actor'>;
  readonly settings: Settings;
  readonly choice: EstimatorChoice;
  readonly headset: Headset;
  readonly activities: Activities;
  readonly timing: FrameTiming;
  /** For this visit only. */
  calibrate(calibration: Calibration): void;
}

/** Takes part in a study: from now on it decides what is played and with which body. */
export async function joinStudy(options: JoinStudyOptions): Promise<JoinedStudy> {
  const { asked, switches, settings, choice, headset, activities, timing, calibrate } = options;
  const { createStudyRun } = await import('../study/study-run');
  settings.startSignal = true;
  const archery = createArcheryRunner({
    async goToArchery(seconds) {
      settings.seconds = seconds;
      await activities.goTo('archery');
      if (!activities.archery) throw new Error('The archery range could not be opened.');
      activities.resetRound();
    },
    startRound: activities.startRound,
    resetRound: activities.resetRound,
    assists: () => (settings.oneHanded ? ['one hand'] : []),
  });
  const ball = createBallRunner({
    async goToBall(place) {
      await activities.goToMatch(place);
      if (!activities.ball) throw new Error('The ball court could not be opened.');
    },
    ball: () => activities.ball?.play ?? null,
    leaveBall: () => void activities.goTo('studio'),
  });
  const run = createStudyRun(asked, {
    runners: { archery, ball },
    enterVr: headset.enter,
    inSession: () => headset.worn,
    calibration: () => settings.calibration,
    setCalibration: calibrate,
    chooseEstimator: (name) => choice.choose(name),
    estimator: () => choice.current.name,
    setActor(on) {
      settings.actor = on && switches.actor;
    },
    setBowSide: activities.setBowSide,
    device: () => ({
      name: `${headset.emulator ? 'emulated headset in ' : ''}${navigator.userAgent}`.slice(0, longestDeviceName),
      refreshRateHz: headset.rateHz,
      input: settings.actor ? 'simulated' : headset.emulator ? 'emulated' : (headset.input ?? 'controllers'),
    }),
    listenToFrames: timing.listen,
  });
  return { run, archery, ball };
}
