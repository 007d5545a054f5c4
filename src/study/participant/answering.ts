import type { Answer } from '../model/questionnaires/question-kind';
import type { Question } from '../model/questionnaires/questionnaire-schema';
import { typedAnswer, unanswered } from '../model/questionnaires/questionnaires';
import type { ParticipantSession } from './participant-session';

type Answered = Pick<ParticipantSession, 'step' | 'progress' | 'apply'>;

/** The questions of the step at hand; none where it is no questionnaire. */
export const screenQuestions = ({ step }: Pick<ParticipantSession, 'step'>): readonly Question[] =>
  step.kind === 'questionnaire' ? step.questionnaire.questions : [];

/** Where a participant is in the questionnaire of the step at hand. */
export class Answering {
  readonly #session: Answered;
  #question = 0;
  #typed: string | null = null;
  #triedToSubmit = false;

  constructor(session: Answered) {
    this.#session = session;
  }

  /** Index of the question shown. */
  get question(): number {
    return this.#question;
  }

  /** What was typed into its field; null: nothing. */
  get typed(): string | null {
    return this.#typed;
  }

  /** Whether handing in failed for want of an answer. */
  get triedToSubmit(): boolean {
    return this.#triedToSubmit;
  }

  /** Another step has begun: its questions begin where the first answer is missing. */
  enterStep(): void {
    this.#triedToSubmit = false;
    this.goTo(Math.max(0, this.#firstOpenQuestion()));
  }

  goTo(index: number): void {
    this.#question = index;
    this.#typed = null;
  }

  /** Why the answer is not taken; null: it is. So below. */
  choose(question: string, value: Answer): string | null {
    return this.#session.apply({ type: 'answer', question, value });
  }

  /** What stands in a field is the answer as soon as it is one; until then there is none. */
  type(question: Question, typed: string): string | null {
    this.#typed = typed;
    const value = typedAnswer(question.answer, typed);
    return this.#session.apply({ type: 'answer', question: question.id, value });
  }

  /** Whether all is answered that must be; else the first open question is shown. */
  readyToSubmit(): boolean {
    const open = this.#firstOpenQuestion();
    if (open < 0) return true;
    this.#triedToSubmit = true;
    this.goTo(open);
    return false;
  }

  /** Index of the first question without an answer; −1: there is none. */
  #firstOpenQuestion(): number {
    const questions = screenQuestions(this.#session);
    const [open] = unanswered({ questions }, this.#session.progress.draft);
    return questions.findIndex(({ id }) => id === open);
  }
}
