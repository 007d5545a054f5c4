import type { PhraseKey } from '../../model/phrases/english';
import type { Phrases } from '../../model/phrases/phrases';
import type { ScreenButton, StudyScreen } from '../questions/study-screen';
import type { ScreenActions } from './study-situation';

/** The parts that the screens of a step share by default. */
export type ScreenBase = Pick<
  StudyScreen,
  'kicker' | 'phrases' | 'figure' | 'part' | 'question' | 'hint' | 'footnote' | 'trouble'
>;

/** The input from which every screen is made. */
export interface ScreenParts {
  readonly base: ScreenBase;
  readonly phrases: Phrases;
  readonly actions: ScreenActions;
}

export const pauseButton = ({ phrases, actions }: ScreenParts): ScreenButton => ({
  id: 'pause',
  label: phrases.text('pause'),
  look: 'plain',
  act: () => actions.apply({ type: 'pause' }),
});

export const enterButton = ({ phrases, actions }: ScreenParts): ScreenButton => ({
  id: 'enter',
  label: phrases.text('enterVr'),
  look: 'primary',
  act: actions.enterVr,
});

export const calibrateButton = (
  { phrases, actions }: ScreenParts,
  label: Extract<PhraseKey, 'measureAgain' | 'measures.begin'>,
): ScreenButton => ({ id: 'calibrate', label: phrases.text(label), look: 'primary', act: actions.calibrate });

export const askToStopButton = ({ phrases, actions }: ScreenParts): ScreenButton => ({
  id: 'ask-to-stop',
  label: phrases.text('stopStudy'),
  look: 'plain',
  act: () => actions.askToStop(true),
});
