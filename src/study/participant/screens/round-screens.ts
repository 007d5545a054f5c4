import type { PlayedStep } from '../../model/plan/schedule';
import { clockText } from '../../model/progress/progress';
import type { StudyScreen } from '../questions/study-screen';
import { enterButton, pauseButton, type ScreenParts } from './screen-parts';
import type { StudySituation } from './study-situation';

/** Returns the screen of a round or a practice, or null while it is played. */
export function roundScreen(parts: ScreenParts, step: PlayedStep, situation: StudySituation): StudyScreen | null {
  const { base, phrases } = parts;
  const { text } = phrases;
  const { inSession, playing, waitingFor, standing, prepared, awaited } = situation;
  if (!inSession) {
    return {
      ...base,
      id: 'trial-enter',
      title: text('headset.title'),
      text: [text('headset.round')],
      buttons: [enterButton(parts), pauseButton(parts)],
    };
  }
  if (playing && waitingFor !== null) {
    const names = { count: waitingFor.length, names: phrases.list(waitingFor) };
    return {
      ...base,
      id: 'waiting',
      title: text('waiting.title'),
      text: [waitingFor.length > 0 ? text('waiting.for', names) : text('waiting.others')],
      buttons: [pauseButton(parts)],
    };
  }
  if (playing && standing) {
    const { participants = [], secondsLeft = null } = awaited ?? {};
    const names = phrases.list(participants);
    return {
      ...base,
      ...{ id: 'standing', title: text('paused.title'), buttons: [pauseButton(parts)] },
      text: [
        awaited === null ? text('standing.text') : text('standing.away', { names }),
        ...(secondsLeft === null ? [] : [text('standing.limit')]),
      ],
      figure: secondsLeft === null ? null : clockText(secondsLeft),
    };
  }
  if (playing) return null;
  if (prepared?.state === 'failed') return failedScreen(parts, prepared.reason, situation);
  return readyScreen(parts, step, situation);
}

function failedScreen({ base, phrases, actions }: ScreenParts, why: string, { session }: StudySituation): StudyScreen {
  const { remote } = session.plan;
  return {
    ...base,
    id: 'trial-failed',
    title: remote ? phrases.text('round.failed') : phrases.text('callExperimenter'),
    text: [why, ...(remote ? [remote.contact] : [])],
    trouble: true,
    buttons: [{ id: 'again', label: phrases.text('tryAgain'), look: 'primary', act: actions.prepareAgain }],
  };
}

function readyScreen(parts: ScreenParts, step: PlayedStep, situation: StudySituation): StudyScreen {
  const { session, prepared, awaited } = situation;
  const { base, actions } = parts;
  const { text } = parts.phrases;
  const { progress, plan } = session;
  const practice = step.kind === 'tutorial';
  const ready = prepared?.state === 'ready' && !progress.running;
  const task = plan.tasks.find(({ id }) => id === step.task);
  const count = Math.round(step.seconds);
  return {
    ...base,
    id: practice ? 'tutorial-ready' : 'trial-ready',
    title: practice ? text('practice') : text('ready.title'),
    text: [
      ...(awaited?.secondsLeft != null
        ? [text('ready.awaited', { time: clockText(awaited.secondsLeft) })]
        : progress.attempt > 1
          ? [text('ready.again')]
          : []),
      ...(task ? [text(`ready.${task.game}`)] : []),
      practice ? text('ready.practice', { count }) : text('ready.seconds', { count }),
      text('ready.raise'),
    ],
    buttons: [
      {
        id: 'start',
        label: ready ? text('start') : text('loading'),
        look: ready ? 'primary' : 'off',
        act: () => actions.apply({ type: 'start' }),
      },
      pauseButton(parts),
    ],
  };
}
