import type { PlayedStep } from '../../model/plan/schedule';
import type { StudyScreen } from '../questions/study-screen';
import { enterButton, pauseButton, type ScreenParts } from './screen-parts';
import type { StudySituation } from './study-situation';

/** Returns the screen of a round or a practice, or null while it is played. */
export function roundScreen(parts: ScreenParts, step: PlayedStep, situation: StudySituation): StudyScreen | null {
  const { base, phrases } = parts;
  const { say } = phrases;
  const { inSession, playing, waitingFor, standing, prepared } = situation;
  if (!inSession) {
    return {
      ...base,
      id: 'trial-enter',
      title: say('headset.title'),
      text: [say('headset.round')],
      buttons: [enterButton(parts), pauseButton(parts)],
    };
  }
  if (playing && waitingFor !== null) {
    const names = { count: waitingFor.length, names: phrases.list(waitingFor) };
    return {
      ...base,
      id: 'waiting',
      title: say('waiting.title'),
      text: [waitingFor.length > 0 ? say('waiting.for', names) : say('waiting.others')],
      buttons: [pauseButton(parts)],
    };
  }
  if (playing && standing) {
    return { ...base, id: 'standing', title: say('paused.title'), text: [say('standing.text')], buttons: [] };
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
    title: remote ? phrases.say('round.failed') : phrases.say('callExperimenter'),
    text: [why, ...(remote ? [remote.contact] : [])],
    trouble: true,
    buttons: [{ id: 'again', label: phrases.say('tryAgain'), look: 'primary', act: actions.prepareAgain }],
  };
}

function readyScreen(parts: ScreenParts, step: PlayedStep, { session, prepared }: StudySituation): StudyScreen {
  const { base, actions } = parts;
  const { say } = parts.phrases;
  const { progress, plan } = session;
  const practice = step.kind === 'tutorial';
  const ready = prepared?.state === 'ready' && !progress.running;
  const game = plan.tasks.find(({ id }) => id === step.task)?.game;
  const count = Math.round(step.seconds);
  return {
    ...base,
    id: practice ? 'tutorial-ready' : 'trial-ready',
    title: practice ? say('practice') : say('ready.title'),
    text: [
      ...(progress.attempt > 1 ? [say('ready.again')] : []),
      game === 'ball' ? say('ready.ball') : say('ready.archery'),
      practice ? say('ready.practice', { count }) : say('ready.seconds', { count }),
      say('ready.raise'),
    ],
    buttons: [
      {
        id: 'start',
        label: ready ? say('start') : say('loading'),
        look: ready ? 'primary' : 'off',
        act: () => actions.apply({ type: 'start' }),
      },
      pauseButton(parts),
    ],
  };
}
