import { text, ValidationError } from 'threepoint/core';
import * as v from 'valibot';
import { english, type GivenPhrases, type Phrase, type PhraseKey } from './english';
import { languageTag } from './localized-text';
import { phraseKeys, placeholdersIn } from './phrases';

const longest = 600;
const form = v.exactOptional(text(longest));

/**
 * The form "other" is needed in every language, further ones where the language has them. A language without plurals
 * has a text only.
 */
const pluralForms = v.union(
  [text(longest), v.strictObject({ zero: form, one: form, two: form, few: form, many: form, other: text(longest) })],
  'expected text, or its plural forms as {"one": "{count} record", "other": "{count} records"}',
);

const inEnglish = (phrase: Phrase): string => (typeof phrase === 'string' ? phrase : phrase.other);

/** A phrase may be left out; editors show the English one. */
const schemaOf = (key: PhraseKey) => {
  const phrase: Phrase = english[key];
  const phraseText = inEnglish(phrase);
  const plain: v.GenericSchema<Phrase> = v.pipe(text(longest), v.description(phraseText));
  return v.exactOptional(typeof phrase === 'string' ? plain : v.pipe(pluralForms, v.description(phraseText)));
};

/** The schema of phrases in other languages or of the study's choice: {"fr": {"next": "Suivant"}}. */
export const phrasesSchema = v.record(
  languageTag,
  v.strictObject(Object.fromEntries(phraseKeys.map((key) => [key, schemaOf(key)]))),
);

const fieldOf = (language: string, key: string, form: string | null): string =>
  `phrases.${language}["${key}"]${form === null ? '' : `.${form}`}`;

const braced = (names: Iterable<string>) => [...names].map((name) => `{${name}}`).join(', ');

/** The letters of a keyboard, limited to the rows and keys that fit the sheet. */
const maxKeys = { rows: 4, inRow: 12 };

function rejectRows(rows: string, field: string): void {
  const found = rows.split(' ');
  if (found.length <= maxKeys.rows && found.every((row) => [...row].length <= maxKeys.inRow)) return;
  throw new ValidationError(field, `expected at most ${maxKeys.rows} rows of at most ${maxKeys.inRow} letters`);
}

/** A plural form may leave the number out, as in "one record"; other texts need all their placeholders. */
function rejectPlaceholders(key: PhraseKey, phraseText: string, field: string, mayLeaveOut: ReadonlySet<string>): void {
  const wanted = placeholdersIn(inEnglish(english[key]));
  const found = placeholdersIn(phraseText);
  const missing = [...wanted].filter((name) => !found.has(name) && !mayLeaveOut.has(name));
  if (missing.length > 0) throw new ValidationError(field, `lacks ${braced(missing)}`);
  const unknown = [...found].filter((name) => !wanted.has(name));
  if (unknown.length > 0) {
    const known = wanted.size > 0 ? `only ${braced(wanted)}` : 'nothing';
    throw new ValidationError(field, `${braced(unknown)} stays empty: ${known} is filled in here`);
  }
}

/** Throws a ValidationError for phrases in a language that the study does not have, and for missing placeholders. */
export function rejectPhrases(phrases: Readonly<Record<string, GivenPhrases>>, languages: readonly string[]): void {
  const whole = new Set<string>();
  const number = new Set(['count']);
  for (const [language, given] of Object.entries(phrases)) {
    if (!languages.includes(language)) {
      throw new ValidationError(
        `phrases.${language}`,
        `the study is not in this language: expected one of ${languages.join(', ')}`,
      );
    }
    for (const [key, phrase] of Object.entries(given) as [PhraseKey, Phrase][]) {
      if (typeof phrase === 'string') {
        rejectPlaceholders(key, phrase, fieldOf(language, key, null), whole);
        if (key === 'keys.rows') rejectRows(phrase, fieldOf(language, key, null));
        continue;
      }
      for (const [name, phraseText] of Object.entries(phrase) as [string, string][]) {
        rejectPlaceholders(key, phraseText, fieldOf(language, key, name), name === 'other' ? whole : number);
      }
    }
  }
}
