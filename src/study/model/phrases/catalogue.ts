import type { english } from './english';

/** The key of a phrase of the page. */
export type PhraseKey = keyof typeof english;

/** The forms of a phrase with a number, by the names of Unicode's plural rules. */
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
/** Phrases of a plan, which may leave out keys. */
export type GivenPhrases = Readonly<Record<string, Phrase | undefined>>;
