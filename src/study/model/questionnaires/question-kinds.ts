import * as v from 'valibot';
import { choice } from './kinds/choice';
import { likert } from './kinds/likert';
import { number } from './kinds/number';
import { slider } from './kinds/slider';
import { text } from './kinds/text';
import type { AnswerForm, QuestionKind } from './question-kind';

type FormSchema = v.StrictObjectSchema<{ readonly kind: v.LiteralSchema<string, undefined> }, undefined>;

const kinds = new Map<string, QuestionKind>();
const schemas: FormSchema[] = [];

/** Returns the names of the registered kinds in the order of registration. */
export const questionKindNames = (): readonly string[] => [...kinds.keys()];

const inWords = (names: readonly string[]) => `${names.slice(0, -1).join(', ')} or ${names.at(-1)}`;

/** The schema of an answer's form. It includes kinds that are registered after it was made. */
export const answerFormSchema = v.variant(
  'kind',
  schemas,
  () => `expected ${inWords(questionKindNames())}`,
) as unknown as v.GenericSchema<unknown, AnswerForm>;

/**
 * Adds a kind of question. A kind has two parts: a `QuestionKind` checks plans and answers, and says what the tables
 * contain; a `QuestionView` draws the question on the desk card and on the VR sheet, and turns what is pressed into an
 * answer. Every process that reads plans registers the first before it reads one: the server's thread, the process of
 * an export, the command line tools and the page. The page also registers the second with `registerQuestionView`.
 * Returns a function that removes the kind; throws an Error if the name is taken.
 *
 * @example
 * declare module './question-kind' {
 *   interface AnswerForms { agreement: { kind: 'agreement'; yes: Words; no: Words } }
 * }
 * registerQuestionKind({
 *   kind: 'agreement',
 *   schema: v.strictObject({ kind: v.literal('agreement'), yes: words(40), no: words(40) }),
 *   answer: () => v.picklist(['yes', 'no'], 'expected yes or no'),
 *   range: () => null,
 *   options: () => ['yes', 'no'],
 *   texts: ({ yes, no }) => [['yes', yes], ['no', no]],
 *   columns: ({ yes, no }, inWords) => ({ answers: `yes: ${inWords(yes)}; no: ${inWords(no)}` }),
 *   simulate: (_, part) => (part < 0.5 ? 'no' : 'yes'),
 * });
 */
export function registerQuestionKind<Form extends AnswerForm>(kind: QuestionKind<Form>): () => void {
  if (kinds.has(kind.kind)) throw new Error(`The kind of question "${kind.kind}" is registered already.`);
  // reason: the form of an answer decides which kind is called with it, and the options of a variant have a literal
  const schema = kind.schema as unknown as FormSchema;
  kinds.set(kind.kind, kind as unknown as QuestionKind);
  schemas.push(schema);
  return () => {
    if (kinds.delete(kind.kind)) schemas.splice(schemas.indexOf(schema), 1);
  };
}

/** Returns the kind of a form; throws an Error if it is not registered. */
export function questionKind({ kind }: { readonly kind: string }): QuestionKind {
  const found = kinds.get(kind);
  if (!found)
    throw new Error(`The kind of question "${kind}" is not registered. Register it with registerQuestionKind.`);
  return found;
}

registerQuestionKind(likert);
registerQuestionKind(slider);
registerQuestionKind(choice);
registerQuestionKind(number);
registerQuestionKind(text);
