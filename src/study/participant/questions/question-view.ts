import type { ComponentChild } from 'preact';
import type { Phrases } from '../../model/phrases/phrases';
import type { Answer, AnswerForm } from '../../model/questionnaires/question-kind';
import type { Target } from './sheet-target';

/** The fields of questions by kind. The view of each kind adds its own field to this interface. */
// biome-ignore lint/suspicious/noEmptyInterface: views merge their fields into it
export interface ScreenFields {}

/** The field in which a question is answered, in the participant's language. */
export type ScreenField = ScreenFields[keyof ScreenFields];

/** The state from which a field is made, and the actions that change it. */
export interface FieldContext {
  readonly phrases: Phrases;
  /** The answer so far; undefined: none. */
  readonly given: Answer | undefined;
  /** The text of the field, an answer or not; null: nothing was typed since the question is shown. */
  readonly typed: string | null;
  choose(value: Answer): void;
  type(typed: string): void;
}

/** How the sheet in the headset shows a field. */
export interface SheetView<Field> {
  /** Returns everything that can be pressed, laid out on the sheet; pressing a target answers the question. */
  targets(field: Field): readonly Target[];
  /** Draws the parts of a field that are not targets; `hovered`: the id of the target that a hand points at. */
  paint?(context: CanvasRenderingContext2D, field: Field, hovered: string | null): void;
  /** Returns the lower edge of the question's text on the sheet [pixels]; 390 if absent. */
  textBottom?(field: Field): number;
}

/** The part of a kind of question that draws; `QuestionKind` is the part that checks. */
export interface QuestionView<Form extends AnswerForm = AnswerForm, Field extends ScreenField = ScreenField> {
  /** The name of the kind in plans. */
  readonly kind: Form['kind'];
  /** Returns the field that card and sheet show. */
  field(form: Form, context: FieldContext): Field;
  /** Returns the content of a field on the desk card. `id` is that of the question. */
  card(field: Field, id: string, phrases: Phrases): ComponentChild;
  readonly sheet: SheetView<Field>;
  /** Returns the hint for typed text that is not an answer. Absent for kinds that are not typed. */
  misread?(form: Form, phrases: Phrases): string;
}
