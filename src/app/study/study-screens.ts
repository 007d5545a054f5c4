import type { Progress } from '../../core/study/progress';
import type { RemoteTerms } from '../../core/study/remote-setup';
import { blindLabel, type StudyStep } from '../../core/study/schedule';
import { type CalibrationStep, calibrationHeadline, calibrationInstruction } from '../../ui/calibration-dialog';
import { counted } from '../../ui/phrases';
import { screenQuestions } from './answering';
import type { Safekeeping } from './participant-session';
import { questionPart } from './question-screen';
import type { ScreenButton, StudyScreen } from './study-screen';
import type { ScreenActions, ShownSession, StudySituation } from './study-situation';
import type { PlayedStep } from './study-trial';

const clock = (seconds: number): string => {
  const whole = Math.ceil(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`;
};

/** Where answers are, in a sentence; the second part says whether they are in danger. `remote`: of a participant who is alone. */
export function safekeepingText(
  { unsent, unsaved, storageFault, online, refusal }: Safekeeping,
  remote?: RemoteTerms,
): readonly [string, boolean] {
  if (refusal !== null && unsent > 0) {
    const what = `the server refuses ${counted(unsent, 'record')} (${refusal})`;
    return remote
      ? [`They stay on this device: ${what}. You can go on. ${remote.contact}`, true]
      : [`Call the experimenter: ${what}. They stay here.`, true];
  }
  if (unsaved > 0) {
    const why = storageFault ?? 'not written yet';
    return storageFault === null
      ? ['Saving …', false]
      : [`Keep this page open: ${counted(unsaved, 'record')} cannot be stored on this device (${why}).`, true];
  }
  if (!online) return [`No connection: ${counted(unsent, 'record')} kept on this device, sent later.`, false];
  return unsent > 0 ? ['Sending …', false] : ['Everything is saved.', false];
}

/** Participants know rounds by number, never by condition. */
function kickerOf(session: ShownSession, step: StudyStep): string {
  if (!('task' in step)) return session.plan.title;
  const { title } = session.plan.tasks.find(({ id }) => id === step.task) ?? { title: step.task };
  if (step.kind === 'tutorial' || (step.kind === 'rest' && step.id.endsWith('after-tutorial')))
    return `${title} · Practice`;
  return `${title} · ${blindLabel(step)}`;
}

/** In the headset, when the place is no longer this device's; the page has more to say. */
export const lockedOutScreen = ({ plan }: ShownSession): StudyScreen => ({
  id: 'locked-out',
  kicker: plan.title,
  title: plan.remote ? 'It does not go on here' : 'Please call the experimenter',
  text: plan.remote
    ? ['Your place was released for another device, or deleted. Take the headset off, please.', plan.remote.contact]
    : ['Your place was released for another device. Take the headset off, please.'],
  figure: null,
  part: null,
  question: null,
  hint: null,
  buttons: [],
  footnote: 'This device sends nothing more.',
  trouble: true,
});

/** What the screens of a step have in common, unless they say otherwise. */
type ScreenBase = Pick<StudyScreen, 'kicker' | 'figure' | 'part' | 'question' | 'hint' | 'footnote' | 'trouble'>;

/** The screen of the step at hand; null while the participant plays. */
export function screenOf(situation: StudySituation, actions: ScreenActions): StudyScreen | null {
  const { session, refusal } = situation;
  const { step, progress } = session;
  const { remote } = session.plan;
  const [kept, worrying] = safekeepingText(session.safekeeping, remote);
  const base: ScreenBase = {
    kicker: kickerOf(session, step),
    figure: null,
    part: null,
    question: null,
    hint: refusal,
    footnote: session.simulated ? `SIMULATED · ${kept}` : kept,
    trouble: worrying,
  };
  if (step.kind !== 'end' && (progress.unwell || situation.stopping))
    return stopScreen(base, { progress, remote }, actions);
  if (progress.paused) return pausedScreen(base, actions);
  switch (step.kind) {
    case 'calibration':
      return calibrationScreen(base, situation, actions);
    case 'tutorial':
    case 'trial':
      return playedScreen(base, step, situation, actions);
    case 'rest':
      return restScreen(base, step, session, actions);
    case 'questionnaire':
      return questionScreen(base, situation, actions);
    case 'end':
      return endScreen(base, situation);
    default:
      return null;
  }
}

const pauseButton = (actions: ScreenActions): ScreenButton => ({
  id: 'pause',
  label: 'Pause',
  look: 'plain',
  act: () => actions.apply({ type: 'pause' }),
});

const enterButton = (actions: ScreenActions): ScreenButton => ({
  id: 'enter',
  label: 'Enter VR',
  look: 'primary',
  act: actions.enterVr,
});

const pausedScreen = (base: ScreenBase, actions: ScreenActions): StudyScreen => ({
  ...base,
  id: 'paused',
  title: 'Paused',
  text: ['Nothing runs on. Take the headset off if you like.'],
  buttons: [
    { id: 'ask-to-stop', label: 'Stop the study', look: 'plain', act: () => actions.askToStop(true) },
    { id: 'resume', label: 'Continue', look: 'primary', act: () => actions.apply({ type: 'resume' }) },
  ],
});

/** Whether to stop: asked because of answers, or because the participant wants to. */
const stopScreen = (
  base: ScreenBase,
  { progress: { unwell }, remote }: { readonly progress: Progress; readonly remote: RemoteTerms | undefined },
  actions: ScreenActions,
): StudyScreen => ({
  ...base,
  id: unwell ? 'unwell' : 'stopping',
  title: unwell ? 'How are you?' : 'Stop here?',
  text: [
    ...(unwell ? ['Your answers say that you may not feel well. Take the headset off if you like.'] : []),
    'If you stop, your part is over. You need not say why, and what you have done until now is kept.',
    ...(unwell && remote ? [`If it does not pass: ${remote.contact}`] : []),
  ],
  buttons: [
    // Where the wish to stop was pressed stands the way back: pressing twice stops nothing.
    {
      id: 'go-on',
      label: unwell ? 'I am well: go on' : 'Go on',
      look: unwell ? 'plain' : 'primary',
      act: () => (unwell ? actions.apply({ type: 'go-on' }) : actions.askToStop(false)),
    },
    {
      id: 'stop',
      label: 'Stop',
      look: unwell ? 'primary' : 'plain',
      act: () => actions.apply({ type: 'stop', by: 'participant' }),
    },
  ],
});

function calibrationScreen(
  base: ScreenBase,
  { session, inSession, calibration, setupFaults }: StudySituation,
  actions: ScreenActions,
): StudyScreen {
  const { remote } = session.plan;
  if (remote && setupFaults.length > 0 && (!calibration || calibration.kind === 'done')) {
    return setupScreen(base, remote, { faults: setupFaults, inSession }, actions);
  }
  if (!inSession) {
    return {
      ...base,
      id: 'calibration-enter',
      title: 'Put on the headset',
      text: [
        'Press the button, put the headset on and take both controllers. You are measured first: it takes five seconds.',
      ],
      buttons: [enterButton(actions), pauseButton(actions)],
    };
  }
  if (calibration) return measuringScreen(base, calibration, actions);
  return {
    ...base,
    id: 'calibration',
    title: 'Your measures',
    text: [
      'Stand straight inside the marked zone, look ahead and stretch both arms forward, wrists straight, when the countdown begins.',
      'Point at the button and pull the trigger, or touch it.',
    ],
    buttons: [{ id: 'calibrate', label: 'Measure me', look: 'primary', act: actions.calibrate }, pauseButton(actions)],
  };
}

/** What keeps a participant who is alone from beginning, and whom they can ask. */
const setupScreen = (
  base: ScreenBase,
  { contact }: RemoteTerms,
  { faults, inSession }: { readonly faults: readonly string[]; readonly inSession: boolean },
  actions: ScreenActions,
): StudyScreen => ({
  ...base,
  id: 'setup',
  title: inSession ? 'Not quite ready' : 'This device cannot be used',
  text: [...faults, `Does it not help? ${contact}`],
  trouble: true,
  buttons: inSession
    ? [{ id: 'calibrate', label: 'Measure again', look: 'primary', act: actions.calibrate }, pauseButton(actions)]
    : [{ id: 'ask-to-stop', label: 'Stop the study', look: 'plain', act: () => actions.askToStop(true) }],
});

function measuringScreen(base: ScreenBase, calibration: CalibrationStep, actions: ScreenActions): StudyScreen {
  const id = `calibration-${calibration.kind}`;
  if (calibration.kind === 'failed') {
    return {
      ...base,
      id,
      title: 'Once more, please',
      text: [calibration.text],
      buttons: [{ id: 'calibrate', label: 'Measure again', look: 'primary', act: actions.calibrate }],
    };
  }
  return {
    ...base,
    id,
    title: 'Stand still',
    text: [calibrationInstruction],
    figure: calibrationHeadline(calibration),
    part: calibration.kind === 'measuring' ? calibration.part : null,
    buttons: [],
  };
}

/** Of a round or a practice; null while it is played. */
function playedScreen(
  base: ScreenBase,
  step: PlayedStep,
  situation: StudySituation,
  actions: ScreenActions,
): StudyScreen | null {
  const { inSession, playing, waitingFor, standing, prepared } = situation;
  const { remote } = situation.session.plan;
  if (!inSession) {
    return {
      ...base,
      id: 'trial-enter',
      title: 'Put on the headset',
      text: ['The next part is played in the headset.'],
      buttons: [enterButton(actions), pauseButton(actions)],
    };
  }
  if (playing && waitingFor !== null) {
    const several = /,| and /.test(waitingFor);
    return {
      ...base,
      id: 'waiting',
      title: 'You are ready',
      text: [`It begins as soon as ${waitingFor} ${several ? 'are' : 'is'} ready too.`],
      buttons: [pauseButton(actions)],
    };
  }
  if (playing && standing) {
    return {
      ...base,
      id: 'standing',
      title: 'Paused',
      text: ['One of your group pauses. The game goes on where it stopped.'],
      buttons: [],
    };
  }
  if (playing) return null;
  if (prepared?.state === 'failed') {
    return {
      ...base,
      id: 'trial-failed',
      title: remote ? 'This round cannot start' : 'Please call the experimenter',
      text: [prepared.reason, ...(remote ? [remote.contact] : [])],
      trouble: true,
      buttons: [{ id: 'again', label: 'Try again', look: 'primary', act: actions.prepareAgain }],
    };
  }
  return readyScreen(base, step, situation, actions);
}

function readyScreen(
  base: ScreenBase,
  step: PlayedStep,
  { session, prepared }: StudySituation,
  actions: ScreenActions,
): StudyScreen {
  const { progress, plan } = session;
  const practice = step.kind === 'tutorial';
  const ready = prepared?.state === 'ready' && !progress.running;
  const rules =
    plan.tasks.find(({ id }) => id === step.task)?.game === 'ball'
      ? 'Two of you throw balls, the third catches them with the basket. Every ball in the basket is a point for all three.'
      : 'Shoot up to five arrows at the four targets. Each target counts once; the farther, the more points.';
  const again = progress.attempt > 1 ? ['The last attempt was interrupted and does not count.'] : [];
  const seconds = Math.round(step.seconds);
  return {
    ...base,
    id: practice ? 'tutorial-ready' : 'trial-ready',
    title: practice ? 'Practice' : 'Ready?',
    text: [
      ...again,
      rules,
      practice
        ? `Try it for ${seconds} seconds. This does not count.`
        : `You have ${seconds} seconds from the start. Stay inside the marked zone.`,
      'To pause or to stop, hold both hands above your head.',
    ],
    buttons: [
      {
        id: 'start',
        label: ready ? 'Start' : 'Loading …',
        look: ready ? 'primary' : 'off',
        act: () => actions.apply({ type: 'start' }),
      },
      pauseButton(actions),
    ],
  };
}

function restScreen(
  base: ScreenBase,
  { seconds }: Extract<StudyStep, { kind: 'rest' }>,
  session: ShownSession,
  actions: ScreenActions,
): StudyScreen {
  const left = session.remaining() ?? 0;
  return {
    ...base,
    id: 'rest',
    title: 'A rest',
    text: ['Relax your arms. It goes on by itself.'],
    figure: clock(left),
    part: seconds > 0 ? 1 - left / seconds : 1,
    buttons: [pauseButton(actions)],
  };
}

function endScreen(base: ScreenBase, { session, withdrawalPage }: StudySituation): StudyScreen {
  const { plan, progress, safekeeping } = session;
  return {
    ...base,
    id: 'end',
    kicker: plan.title,
    title: 'Thank you',
    text: [
      progress.stopped ? 'Your part is over. Take the headset off and rest.' : 'You have done everything.',
      safekeeping.unsent === 0
        ? 'All your answers have arrived. You can close this page.'
        : 'Please keep this page open until your answers have arrived.',
      `With your withdrawal code you can have everything deleted: ${withdrawalPage.replace(/^https?:\/\//, '')}`,
    ],
    buttons: [],
  };
}

function questionScreen(base: ScreenBase, situation: StudySituation, actions: ScreenActions): StudyScreen {
  const { session, question: index } = situation;
  const questions = screenQuestions(session);
  const at = Math.min(index, questions.length - 1);
  const last = at === questions.length - 1;
  const left = session.remaining();
  const time = left === null ? '' : left > 0 ? `${clock(left)} left` : 'Take the time you need.';
  const { question, hint } = questionPart(questions, at, situation, actions);
  return {
    ...base,
    id: `question-${question.id}`,
    title: question.text,
    text: [],
    hint,
    question,
    buttons: [
      { id: 'back', label: 'Back', look: at === 0 ? 'off' : 'plain', act: () => actions.goTo(at - 1) },
      pauseButton(actions),
      last
        ? { id: 'submit', label: 'Hand in', look: 'primary', act: actions.submit }
        : { id: 'next', label: 'Next', look: 'primary', act: () => actions.goTo(at + 1) },
    ],
    footnote: time ? `${time} · ${base.footnote}` : base.footnote,
  };
}
