import type { CalibrationStep } from 'threepoint-ui';
import type { Phrases } from '../../model/phrases/phrases';
import type { RemoteTerms } from '../../model/plan/remote-setup';
import type { StudyScreen } from '../questions/study-screen';
import { askToStopButton, calibrateButton, enterButton, pauseButton, type ScreenParts } from './screen-parts';
import type { StudySituation } from './study-situation';

/** Returns the screens before and during a measurement: putting the headset on, faults of the set-up, measuring. */
export function calibrationScreen(
  parts: ScreenParts,
  { session, inSession, calibration, setupProblems }: StudySituation,
): StudyScreen {
  const { base, phrases } = parts;
  const { text } = phrases;
  const { remote } = session.plan;
  if (remote && setupProblems.length > 0 && (!calibration || calibration.kind === 'done')) {
    return setupScreen(parts, remote, { problems: setupProblems, inSession });
  }
  if (!inSession) {
    return {
      ...base,
      id: 'calibration-enter',
      title: text('headset.title'),
      text: [text('headset.measures')],
      buttons: [enterButton(parts), pauseButton(parts)],
    };
  }
  if (calibration) return measuringScreen(parts, calibration);
  return {
    ...base,
    id: 'calibration',
    title: text('measures.title'),
    text: [text('measures.stance'), text('measures.press')],
    buttons: [calibrateButton(parts, 'measures.begin'), pauseButton(parts)],
  };
}

/** Shows why a participant who takes part alone cannot begin, and the contact. */
function setupScreen(
  parts: ScreenParts,
  { contact }: RemoteTerms,
  { problems, inSession }: { readonly problems: readonly string[]; readonly inSession: boolean },
): StudyScreen {
  const { text } = parts.phrases;
  return {
    ...parts.base,
    id: 'setup',
    title: inSession ? text('setup.title') : text('setup.device'),
    text: [...problems, text('setup.contact', { contact })],
    trouble: true,
    buttons: inSession ? [calibrateButton(parts, 'measureAgain'), pauseButton(parts)] : [askToStopButton(parts)],
  };
}

/** Returns a step of the measurement in one word or number. */
function headlineOf(step: Exclude<CalibrationStep, { kind: 'failed' }>, { text }: Phrases): string {
  if (step.kind === 'countdown') return String(Math.ceil(step.secondsLeft));
  return step.kind === 'measuring' ? text('measuring.hold') : text('measuring.done');
}

function measuringScreen(parts: ScreenParts, calibration: CalibrationStep): StudyScreen {
  const { base, phrases } = parts;
  const id = `calibration-${calibration.kind}`;
  if (calibration.kind === 'failed') {
    return {
      ...base,
      id,
      title: phrases.text('measuring.failed'),
      text: [phrases.text(`measuring.${calibration.fault}`)],
      buttons: [calibrateButton(parts, 'measureAgain')],
    };
  }
  return {
    ...base,
    id,
    title: phrases.text('measuring.title'),
    text: [phrases.text('measuring.instruction')],
    figure: headlineOf(calibration, phrases),
    part: calibration.kind === 'measuring' ? calibration.part : null,
    buttons: [],
  };
}
