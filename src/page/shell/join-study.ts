import type { BodySolver } from 'threepoint/api/body-solver';
import { PhrasedError } from 'threepoint-study/model/phrases/phrases';
import type { Activities } from './activities';
import { type EmbodyingParts, embody } from './embody';
import type { FrameTiming } from './frame-timing';
import type { Headset } from './headset';
import type { JoinedStudy } from './page-study';
import type { Settings } from './settings';
import { createArcheryRunner } from './study-archery';
import { createBallRunner } from './study-ball';
import type { Switches } from './switches';
import type { Wearer } from './wearer';

/** Characters of the device's name that a record keeps. */
const longestDeviceName = 160;

export interface JoinStudyOptions extends EmbodyingParts {
  readonly asked: NonNullable<Switches['study']>;
  readonly switches: Pick<Switches, 'actor'>;
  readonly settings: Settings;
  readonly headset: Headset;
  readonly activities: Activities;
  readonly timing: FrameTiming;
  readonly body: EmbodyingParts['body'] & Pick<BodySolver, 'wearerCalibration'>;
  readonly wearer: Pick<Wearer, 'calibrate' | 'forget'>;
}

/** Takes part in a study: from now on it decides what is played and with which body. */
export async function joinStudy(options: JoinStudyOptions): Promise<JoinedStudy> {
  const { asked, switches, settings, writer, headset, activities, timing, body, wearer } = options;
  const { createStudyRun } = await import('threepoint-study/participant/study-run');
  writer.change({ startSignal: true });
  const archery = createArcheryRunner({
    async goToArchery(seconds) {
      writer.change({ seconds });
      await activities.goTo('archery');
      if (!activities.archery) throw new PhrasedError('round.archery');
      activities.resetRound();
    },
    startRound: (seed, seconds) => activities.startRound(seed, seconds),
    resetRound: () => activities.resetRound(),
    assists: () => (settings.oneHanded ? ['one hand'] : []),
  });
  const ball = createBallRunner({
    async goToBall(place) {
      await activities.goToMatch(place);
      if (!activities.ball) throw new PhrasedError('round.ball');
    },
    ball: () => activities.ball?.play ?? null,
    leaveBall: () => void activities.goTo('studio'),
  });
  const run = createStudyRun(asked, {
    runners: { archery, ball },
    enterVr: () => headset.enter(),
    inSession: () => headset.worn,
    deviceFault: () => headset.fault,
    room: () => headset.room,
    calibration: () => body.wearerCalibration,
    setCalibration(calibration) {
      if (calibration) wearer.calibrate(calibration, 'measured');
      else wearer.forget();
    },
    embody: (embodiment, seed) => embody(options, embodiment, seed),
    estimator: () => body.estimator,
    setActor(on) {
      writer.change({ actor: on && switches.actor });
    },
    setBowSide: (side) => activities.setBowSide(side),
    device: () => ({
      name: `${headset.emulator ? 'emulated headset in ' : ''}${navigator.userAgent}`.slice(0, longestDeviceName),
      refreshRateHz: headset.rateHz,
      input: settings.actor ? 'simulated' : headset.emulator ? 'emulated' : (headset.input ?? 'controllers'),
    }),
    listenToFrames: timing.listen,
  });
  return { run, archery, ball };
}
