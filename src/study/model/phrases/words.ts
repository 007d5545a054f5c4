import { text } from 'threepoint/core/validation/validation';
import * as v from 'valibot';

/** Text for participants: alike in all languages, or one for each. */
export type Words = string | Readonly<Record<string, string>>;

const aLanguage = 'expected a language, as "en", "de" or "pt-BR"';

/** Whether plural rules, lists and names of languages can be had for it. */
function isLocale(tag: string): boolean {
  try {
    return Intl.getCanonicalLocales(tag).length === 1;
  } catch {
    // reason: this is how Intl says no
    return false;
  }
}

/** A language as BCP 47 names it: en, de, pt-BR. */
export const languageTag = v.pipe(
  v.string('expected a language, as "en"'),
  v.regex(/^[a-z]{2,3}(-[A-Za-z0-9]{2,8})*$/, aLanguage),
  v.check(isLocale, aLanguage),
);

/** The schema of text for participants of at most so many characters in each language. */
export const words = (maxLength: number) =>
  v.union(
    [text(maxLength), v.record(languageTag, text(maxLength))],
    'expected text, or texts by language as {"en": "Yes", "de": "Ja"}',
  );

/** The text in a language; where it is not given in that one, in the first that it is given in. */
export const inLanguage = (text: Words, language: string): string =>
  typeof text === 'string' ? text : (text[language] ?? Object.values(text)[0] ?? '');

/** The first of the languages in which the text is not given; null: it serves them all. */
export const missingLanguage = (text: Words, languages: readonly string[]): string | null =>
  typeof text === 'string' ? null : (languages.find((language) => text[language] === undefined) ?? null);
