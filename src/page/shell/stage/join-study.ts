import type { ActivityRunner } from '../../activity/activity';
import { home } from '../activity-registry';
import type { PageStudy } from '../session/page-study';
import type { Switches } from '../session/switches';
import { embody } from './embody';
import type { StageParts } from './stage-parts';

/** Characters of the device's name that a record keeps. */
const longestDeviceName = 160;

/** Makes the tasks that studies run, by the names of their activities. */
export async function createRunners({ activities, settings, writer }: StageParts): Promise<PageStudy['runners']> {
  const runners: Record<string, ActivityRunner> = {};
  for (const { name, createRunner } of activities.all) {
    const runner = await createRunner?.({
      settings,
      writer,
      opened: () => activities.openedOf(name),
      open: (place) => activities.openAt(name, place),
      leave: () => void activities.goTo(home),
    });
    if (runner) runners[name] = runner;
  }
  return runners;
}

/** Joins a study, which decides from then on what is played and with which body. */
export async function joinStudy(parts: StageParts, asked: NonNullable<Switches['study']>): Promise<void> {
  const { switches, settings, writer, headset, timing, body, userCalibration, study, stage } = parts;
  const { createStudyRun } = await import('threepoint-study/participant');
  writer.change({ startSignal: true });
  study.runners = await createRunners(parts);
  study.run = createStudyRun(asked, {
    runners: study.runners,
    enterVr: () => headset.enter(),
    inSession: () => headset.worn,
    deviceFault: () => headset.fault,
    room: () => headset.room,
    calibration: () => body.userCalibration,
    setCalibration(calibration) {
      if (calibration) userCalibration.calibrate(calibration, 'measured');
      else userCalibration.forget();
    },
    embody: (embodiment, seed) => embody(parts, embodiment, seed),
    estimator: () => body.estimator,
    setActor(on) {
      writer.change({ actor: on && switches.actor });
    },
    setBowSide: (bowSide) => writer.change({ bowSide }),
    device: () => ({
      name: `${headset.emulator ? 'emulated headset in ' : ''}${navigator.userAgent}`.slice(0, longestDeviceName),
      refreshRateHz: headset.rateHz,
      input: settings.actor ? 'simulated' : headset.emulator ? 'emulated' : (headset.input ?? 'controllers'),
    }),
    listenToFrames: (listener) => timing.listen(listener),
  });
  stage.studio.scene.add(study.run.object);
}
