import * as v from 'valibot';

/** The error of an invalid input; the message names the field: "paper.json: tasks[1].seconds: expected a number". */
export class ValidationError extends Error {
  /** The path of the field; empty: the whole input. */
  readonly field: string;
  readonly complaint: string;

  constructor(field: string, complaint: string, file?: string) {
    super([file, field, complaint].filter(Boolean).join(': '));
    this.field = field;
    this.complaint = complaint;
  }
}

/** Returns the path of a value as in code: tasks[1].seconds, phrases.fr["rest.title"]. */
function fieldOf(issue: v.BaseIssue<unknown>): string {
  return (issue.path ?? []).reduce((way, { key }) => {
    if (typeof key === 'number') return `${way}[${key}]`;
    if (!/^[\w$-]*$/.test(String(key))) return `${way}["${String(key)}"]`;
    return way ? `${way}.${String(key)}` : String(key);
  }, '');
}

const kindsInWords: Readonly<Record<string, string>> = {
  string: 'text',
  number: 'a number',
  boolean: 'true or false',
  Array: 'a list',
  Object: 'an object',
};

/** Returns the fault, for schemas without their own message. */
function complaintOf({ kind, expected, received }: v.BaseIssue<unknown>): string {
  if (expected === 'never') return 'is not known here';
  if (kind === 'schema' && received === 'undefined') return 'is missing';
  const words = expected
    ?.replace(/^\((.*)\)$/, '$1')
    .replaceAll('"', '')
    .replaceAll(' | ', ' or ');
  return words ? `expected ${kindsInWords[words] ?? words}` : 'is not what it should be';
}

/** Returns the parsed value; throws a ValidationError that names the first invalid field. */
export function checked<Schema extends v.GenericSchema>(schema: Schema, value: unknown): v.InferOutput<Schema> {
  const result = v.safeParse(schema, value, { abortEarly: true, message: complaintOf });
  if (result.success) return result.output;
  const [issue] = result.issues;
  throw new ValidationError(fieldOf(issue), issue.message);
}

/** Returns all faults of a value, in the order of its fields. */
export function complaintsAbout(
  schema: v.GenericSchema,
  value: unknown,
): readonly { readonly field: string; readonly complaint: string }[] {
  const { issues = [] } = v.safeParse(schema, value, { abortPipeEarly: true, message: complaintOf });
  return issues.map((issue) => ({ field: fieldOf(issue), complaint: issue.message }));
}

/** A name for addresses, file names and tables. */
export const identifier = v.pipe(
  v.string(),
  v.regex(
    /^[a-z0-9][a-z0-9-]{0,47}$/,
    'expected small letters, digits and hyphens, at most 48, a letter or digit first',
  ),
);

/** P01 to P999: the number is the place in the plan. */
export const participantId = v.pipe(v.string(), v.regex(/^P\d{2,3}$/, 'expected P and two or three digits, as P01'));

/** Text for people: not empty, bounded. */
export const text = (maxLength: number) =>
  v.pipe(
    v.string('expected text'),
    v.trim(),
    v.minLength(1, 'expected text, found none'),
    v.maxLength(maxLength, `expected at most ${maxLength} characters`),
  );

const between = (min: number, max: number) => `expected a number from ${min} to ${max}`;

export const numberBetween = (min: number, max: number) =>
  v.pipe(
    v.number(between(min, max)),
    v.finite(between(min, max)),
    v.minValue(min, between(min, max)),
    v.maxValue(max, between(min, max)),
  );

const wholeBetween = (min: number, max: number) => `expected a whole number from ${min} to ${max}`;

export const integerBetween = (min: number, max: number) =>
  v.pipe(
    v.number(wholeBetween(min, max)),
    v.integer(wholeBetween(min, max)),
    v.minValue(min, wholeBetween(min, max)),
    v.maxValue(max, wholeBetween(min, max)),
  );

const handTilt = v.object({ pitch: numberBetween(-1, 1), yaw: numberBetween(-1, 1) });

/** The tilts of the measured hands to their forearms [rad]. */
export const handTiltsSchema = v.object({ left: v.optional(handTilt), right: v.optional(handTilt) });
