import { inLanguage } from '../../model/phrases/localized-text';
import type { Phrases } from '../../model/phrases/phrases';
import { taskTitle } from '../../model/plan/plan';
import type { RemoteTerms } from '../../model/plan/remote-setup';
import type { StudyStep } from '../../model/plan/schedule';
import { clockText, type Progress } from '../../model/progress/progress';
import type { StudyScreen } from '../questions/study-screen';
import type { UploadStatus } from '../session/participant-session';
import { noStorage } from '../session/session-store';
import { silentStorage } from '../session/storage-timeout';
import { calibrationScreen } from './calibration-screens';
import { questionScreen } from './question-screen';
import { roundScreen } from './round-screens';
import { askToStopButton, pauseButton, type ScreenParts } from './screen-parts';
import type { ScreenActions, ShownSession, StudySituation } from './study-situation';

/** Why the device could not store, in the participant's language where the page knows the reason. */
function storageReason(problem: string, text: Phrases['text']): string {
  if (problem === noStorage) return text('kept.noStorage');
  return problem === silentStorage ? text('kept.silentStorage') : problem;
}

/**
 * Returns the upload status in a sentence, and whether data are at risk. `remote` is for a participant who takes part
 * alone.
 */
export function uploadStatusText(
  { unsent, unsaved, storageFault, online, rejection }: UploadStatus,
  { text }: Phrases,
  remote?: RemoteTerms,
): readonly [string, boolean] {
  if (rejection !== null && unsent > 0) {
    const what = { count: unsent, reason: rejection };
    return [
      remote ? text('kept.refusedRemote', { ...what, contact: remote.contact }) : text('kept.refused', what),
      true,
    ];
  }
  if (unsaved > 0) {
    if (storageFault === null) return [text('kept.saving'), false];
    const reason = storageReason(storageFault, text);
    return [text('kept.noRoom', { count: unsaved, reason }), true];
  }
  if (!online) return [text('kept.offline', { count: unsent }), false];
  return [unsent > 0 ? text('kept.sending') : text('kept.all'), false];
}

/** Returns the line above the title. Participants know rounds by number, never by condition. */
function kickerOf({ plan, phrases }: ShownSession, step: StudyStep): string {
  if (!('task' in step)) return inLanguage(plan.title, phrases.language);
  const title = taskTitle(plan, step.task, phrases.language);
  const practice = step.kind === 'tutorial' || (step.kind === 'rest' && step.id.endsWith('after-tutorial'));
  return `${title} · ${practice ? phrases.text('practice') : phrases.text('round', { number: step.block })}`;
}

/** Returns the screen in the headset after the place was given to another device. The form on the page says more. */
export const lockedOutScreen = ({ plan, phrases }: ShownSession): StudyScreen => ({
  id: 'locked-out',
  phrases,
  kicker: inLanguage(plan.title, phrases.language),
  title: phrases.text(plan.remote ? 'lockedOut.title' : 'callExperimenter'),
  text: plan.remote ? [phrases.text('lockedOut.deleted'), plan.remote.contact] : [phrases.text('lockedOut.released')],
  figure: null,
  part: null,
  question: null,
  hint: null,
  buttons: [],
  footnote: phrases.text('lockedOut.silent'),
  trouble: true,
});

/** Returns the screen of the present step in the participant's language, or null while the participant plays. */
export function screenOf(situation: StudySituation, actions: ScreenActions): StudyScreen | null {
  const screen = plainScreenOf(situation, actions);
  const { progress, phrases } = situation.session;
  return screen && progress.voided ? { ...screen, text: [phrases.text('voided'), ...screen.text] } : screen;
}

/** Returns the screen without the notice of a void block. */
function plainScreenOf(situation: StudySituation, actions: ScreenActions): StudyScreen | null {
  const { session, rejection } = situation;
  const { step, progress, phrases } = session;
  const { remote } = session.plan;
  const [kept, worrying] = uploadStatusText(session.uploadStatus, phrases, remote);
  const base = {
    kicker: kickerOf(session, step),
    phrases,
    figure: null,
    part: null,
    question: null,
    hint: rejection,
    footnote: session.simulated ? `${phrases.text('simulated')} · ${kept}` : kept,
    trouble: worrying,
  };
  const parts: ScreenParts = { base, phrases, actions };
  if (step.kind !== 'end' && (progress.unwell || situation.stopping)) return stopScreen(parts, progress, remote);
  if (progress.paused) return pausedScreen(parts);
  switch (step.kind) {
    case 'calibration':
      return calibrationScreen(parts, situation);
    case 'tutorial':
    case 'trial':
      return roundScreen(parts, step, situation);
    case 'rest':
      return restScreen(parts, step, session);
    case 'questionnaire':
      return questionScreen(parts, situation);
    case 'end':
      return endScreen(parts, situation);
    default:
      return null;
  }
}

const pausedScreen = (parts: ScreenParts): StudyScreen => ({
  ...parts.base,
  id: 'paused',
  title: parts.phrases.text('paused.title'),
  text: [parts.phrases.text('paused.text')],
  buttons: [
    askToStopButton(parts),
    {
      id: 'resume',
      label: parts.phrases.text('continue'),
      look: 'primary',
      act: () => parts.actions.apply({ type: 'resume' }),
    },
  ],
});

/** Asks whether to stop, because of answers or because the participant wants to. */
function stopScreen(
  { base, phrases: { text }, actions }: ScreenParts,
  { unwell }: Progress,
  remote: RemoteTerms | undefined,
): StudyScreen {
  return {
    ...base,
    id: unwell ? 'unwell' : 'stopping',
    title: unwell ? text('unwell.title') : text('stopping.title'),
    text: [
      ...(unwell ? [text('unwell.text')] : []),
      text('stopping.text'),
      ...(unwell && remote ? [text('unwell.contact', { contact: remote.contact })] : []),
    ],
    buttons: [
      // The way back is where the button to stop was, so that pressing twice stops nothing.
      {
        id: 'go-on',
        label: unwell ? text('unwell.goOn') : text('stopping.goOn'),
        look: unwell ? 'plain' : 'primary',
        act: () => (unwell ? actions.apply({ type: 'go-on' }) : actions.askToStop(false)),
      },
      {
        id: 'stop',
        label: text('stop'),
        look: unwell ? 'primary' : 'plain',
        act: () => actions.apply({ type: 'stop', by: 'participant' }),
      },
    ],
  };
}

function restScreen(
  parts: ScreenParts,
  { seconds }: Extract<StudyStep, { kind: 'rest' }>,
  session: ShownSession,
): StudyScreen {
  const left = session.remaining() ?? 0;
  return {
    ...parts.base,
    id: 'rest',
    title: parts.phrases.text('rest.title'),
    text: [parts.phrases.text('rest.text')],
    figure: clockText(left),
    part: seconds > 0 ? 1 - left / seconds : 1,
    buttons: [pauseButton(parts)],
  };
}

function endScreen({ base, phrases }: ScreenParts, { session, withdrawalPage }: StudySituation): StudyScreen {
  const { plan, progress, uploadStatus } = session;
  const { text } = phrases;
  return {
    ...base,
    id: 'end',
    kicker: inLanguage(plan.title, phrases.language),
    title: text('end.title'),
    text: [
      progress.stopped ? text('end.stopped') : text('end.done'),
      uploadStatus.unsent === 0 ? text('end.arrived') : text('end.keepOpen'),
      text('end.withdraw', { address: withdrawalPage.replace(/^https?:\/\//, '') }),
    ],
    buttons: [],
  };
}
