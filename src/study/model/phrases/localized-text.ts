import { text } from 'threepoint/core';
import * as v from 'valibot';

/** A text for participants: one for all languages, or one for each. */
export type LocalizedText = string | Readonly<Record<string, string>>;

const aLanguage = 'expected a language, as "en", "de" or "pt-BR"';

/** Returns whether Intl supports the language. */
function isLocale(tag: string): boolean {
  try {
    return Intl.getCanonicalLocales(tag).length === 1;
  } catch {
    // reason: this is how Intl says no
    return false;
  }
}

/** A language as a BCP 47 tag: en, de, pt-BR. */
export const languageTag = v.pipe(
  v.string('expected a language, as "en"'),
  v.regex(/^[a-z]{2,3}(-[A-Za-z0-9]{2,8})*$/, aLanguage),
  v.check(isLocale, aLanguage),
);

/** Returns the schema of a text for participants with a limit in each language. */
export const words = (maxLength: number) =>
  v.union(
    [text(maxLength), v.record(languageTag, text(maxLength))],
    'expected text, or texts by language as {"en": "Yes", "de": "Ja"}',
  );

/** Returns the text in a language, or in the first language that it has. */
export const inLanguage = (text: LocalizedText, language: string): string =>
  typeof text === 'string' ? text : (text[language] ?? Object.values(text)[0] ?? '');

/** Returns the first of the languages that the text lacks, or null. */
export const missingLanguage = (text: LocalizedText, languages: readonly string[]): string | null =>
  typeof text === 'string' ? null : (languages.find((language) => text[language] === undefined) ?? null);
