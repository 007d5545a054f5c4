import { type Embodiment, PhrasedError } from 'threepoint-study';
import type { ActivityRunner } from '../../activity/activity';
import { home } from '../activity-registry';
import type { PageStudy } from '../session/page-study';
import type { Switches } from '../session/switches';
import type { StageParts } from './stage-parts';

/**
 * Gives the participant the body of a round for this visit; resolves when it is drawn. Rejects with a sentence if it
 * cannot be drawn. Settings that the embodiment lacks are unchanged, and a degradation that it lacks is switched off.
 * `seed`: of the random parts of the degradation.
 */
export async function embody(parts: StageParts, embodiment: Embodiment, seed: number): Promise<void> {
  const { writer, avatar, body, degradation } = parts;
  const { estimator, avatar: builtInBody, mirror, upperBodyOnly, ...degradationSettings } = embodiment;
  writer.change({
    ...(mirror !== undefined && { mirror }),
    ...(upperBodyOnly !== undefined && { upperBodyOnly }),
    ...(builtInBody !== undefined && { builtInBody }),
  });
  degradation.configure(degradationSettings, seed);
  const wears = builtInBody === undefined || builtInBody === avatar.builtInBody || avatar.openBuiltIn();
  const [worn] = await Promise.all([wears, body.setEstimator(estimator)]);
  if (!worn || body.estimator !== estimator) throw new PhrasedError('round.body');
}

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
    deviceProblem: () => headset.fault,
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
