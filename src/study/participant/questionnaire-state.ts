import type { Rejection } from '../model/progress/rejection';
import type { Answer } from '../model/questionnaires/question-kind';
import type { Question } from '../model/questionnaires/questionnaire-schema';
import { typedAnswer, unanswered } from '../model/questionnaires/questionnaires';
import type { ParticipantSession } from './session/participant-session';

type Answered = Pick<ParticipantSession, 'step' | 'progress' | 'apply'>;

/** Returns the questions of the present step; none unless it is a questionnaire. */
export const screenQuestions = ({ step }: Pick<ParticipantSession, 'step'>): readonly Question[] =>
  step.kind === 'questionnaire' ? step.questionnaire.questions : [];

/** The position of a participant in the questionnaire of the present step. */
export class QuestionnaireState {
  readonly #session: Answered;
  /** The index of the question on display. */
  question = 0;
  /** The text that was typed into its field; null: none. */
  typed: string | null = null;
  /** Whether handing in failed because an answer is missing. */
  triedToSubmit = false;

  constructor(session: Answered) {
    this.#session = session;
  }

  /** Called when another step has begun. Its questions start at the first one without an answer. */
  enterStep(): void {
    this.triedToSubmit = false;
    this.goTo(Math.max(0, this.#firstOpenQuestion()));
  }

  goTo(index: number): void {
    this.question = index;
    this.typed = null;
  }

  /** Answers a question; returns why the answer is refused, or null if it is taken. */
  choose(question: string, value: Answer): Rejection | null {
    return this.#session.apply({ type: 'answer', question, value });
  }

  /**
   * Takes typed text as the answer if it is valid, and otherwise removes the answer; returns why that is refused, or
   * null.
   */
  type(question: Question, typed: string): Rejection | null {
    this.typed = typed;
    const value = typedAnswer(question.answer, typed);
    return this.#session.apply({ type: 'answer', question: question.id, value });
  }

  /** Returns whether every required question is answered; otherwise shows the first open one. */
  readyToSubmit(): boolean {
    const open = this.#firstOpenQuestion();
    if (open < 0) return true;
    this.triedToSubmit = true;
    this.goTo(open);
    return false;
  }

  /** Returns the index of the first required question without an answer, or −1. */
  #firstOpenQuestion(): number {
    const questions = screenQuestions(this.#session);
    const [open] = unanswered({ questions }, this.#session.progress.draft);
    return questions.findIndex(({ id }) => id === open);
  }
}
