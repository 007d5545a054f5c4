import type * as v from 'valibot';
import type { LocalizedText } from '../phrases/localized-text';

/** An answer as it is recorded: a number, or a text (typed by the participant, or the value of the chosen option). */
export type Answer = number | string;

/** The forms of answers by kind. The module of each kind adds its own form to this interface. */
// biome-ignore lint/suspicious/noEmptyInterface: kinds merge their forms into it
export interface AnswerForms {}

/** The form in which a question is answered, as a plan has it. */
export type AnswerForm = AnswerForms[keyof AnswerForms];

/**
 * The part of a kind of question that runs in the page, on the server and in the command line tools: how plans and
 * answers are checked, and what tables say about them. A `QuestionView` is the part that draws.
 */
export interface QuestionKind<Form extends AnswerForm = AnswerForm> {
  /** The name of the kind, which is the `kind` of its forms. */
  readonly kind: Form['kind'];
  /** The schema of a form: a strict object whose `kind` is a literal. */
  readonly schema: v.GenericSchema<unknown, Form>;
  /** Throws a ValidationError below `field` if parts of a form contradict each other. */
  check?(form: Form, field: string): void;
  /** Returns the schema of an answer. Its message says what is expected: "expected a whole number from 1 to 5". */
  answer(form: Form): v.GenericSchema<unknown, Answer>;
  /**
   * Returns the least and the greatest answer, or null if answers are not numbers. Scales are computed from numbers
   * only.
   */
  range(form: Form): readonly [number, number] | null;
  /**
   * Returns the values to choose from, or null if answers are not chosen from a list. Weighted means count such
   * choices.
   */
  options(form: Form): readonly string[] | null;
  /** Returns every text of a form that participants read, with its path in the form. */
  texts(form: Form): readonly (readonly [string, LocalizedText])[];
  /**
   * Returns the texts at the low end and at the high end of numeric answers, for axes of charts. Absent: there are
   * none.
   */
  ends?(form: Form): { readonly low?: LocalizedText | undefined; readonly high?: LocalizedText | undefined };
  /** Converts typed text to an answer, which is checked by `answer`. Absent for kinds that are not typed. */
  parse?(typed: string): unknown;
  /** Returns the values of the columns that the table questions.csv has about a form, with texts in one language. */
  columns(form: Form, inWords: (text: LocalizedText) => string): { readonly answers: string };
  /** Returns the answer of a simulated participant at `part` of the way from the low end to the high end, in [0, 1]. */
  simulate(form: Form, part: number, uniform: () => number): Answer;
}
