import type { english } from './english';

/** A key of a phrase that the page says to participants. */
export type PhraseKey = keyof typeof english;

/** Of a phrase with a number, the forms that the language has, by the names of Unicode's plural rules. */
export interface PluralForms {
  readonly zero?: string;
  readonly one?: string;
  readonly two?: string;
  readonly few?: string;
  readonly many?: string;
  readonly other: string;
}
export type Phrase = string | PluralForms;
/** The page's phrases in one language. */
export type Catalogue = Readonly<Record<PhraseKey, Phrase>>;
/** Some of them, as a plan gives them. */
export type GivenPhrases = Readonly<Record<string, Phrase | undefined>>;
