import { type Catalogue, english, type GivenPhrases, type PhraseKey } from './english';
import { gamePhrases } from './game-phrases';
import germanOfPage from './german.json' with { type: 'json' };

type TextsOf<Said> = Said extends string ? Said : Said[keyof Said];
type NamesIn<Text> = Text extends `${string}{${infer Name}}${infer Rest}` ? Name | NamesIn<Rest> : never;
type Gap<Key extends PhraseKey> = NamesIn<TextsOf<(typeof english)[Key]>>;
/** A key of a phrase without placeholders. */
export type PlainKey = { [Key in PhraseKey]: [Gap<Key>] extends [never] ? Key : never }[PhraseKey];
/** The values of a phrase's placeholders; nothing if it has none. */
export type Values<Key extends PhraseKey> = [Gap<Key>] extends [never]
  ? readonly []
  : readonly [{ readonly [Name in Gap<Key>]: Name extends 'count' ? number : string | number }];

export const phraseKeys = Object.keys(english) as readonly PhraseKey[];

const german = { ...germanOfPage, ...gamePhrases('de', 'ready'), ...gamePhrases('de', 'round') };

/** The phrases of the page by language. */
export const shippedPhrases: Readonly<Record<string, Catalogue>> = { en: english, de: german };
/** The languages in which the page has every phrase. */
export const shippedLanguages = Object.keys(shippedPhrases) as unknown as readonly [string, ...string[]];

/** The names of the placeholders in a text: "{count} of {total}" has count and total. */
export const placeholdersIn = (text: string): ReadonlySet<string> =>
  new Set([...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name as string));

/** Returns de for de-AT. */
const baseOf = (language: string): string => language.split('-')[0] as string;

const shippedIn = (language: string): Catalogue | undefined =>
  shippedPhrases[language] ?? shippedPhrases[baseOf(language)];

/** Returns the keys that neither the page nor these phrases of a plan have in a language, so that English is shown. */
export const missingKeys = (language: string, given: GivenPhrases = {}): readonly PhraseKey[] =>
  shippedIn(language) ? [] : phraseKeys.filter((key) => !Object.hasOwn(given, key));

/**
 * Returns the offered language that a reader prefers, with the preferred ones in order; otherwise the first offered
 * one.
 */
export function preferredLanguage(offered: readonly [string, ...string[]], wanted: readonly string[]): string {
  for (const want of wanted.map((one) => one.toLowerCase())) {
    const alike = (match: (language: string) => boolean) => offered.find((one) => match(one.toLowerCase()));
    const found = alike((one) => one === want) ?? alike((one) => baseOf(one) === baseOf(want));
    if (found !== undefined) return found;
  }
  return offered[0];
}

/** The phrases of the page in one language. */
export class Phrases {
  readonly language: string;
  /** The language of the phrases: English if the page has none in the participant's language. */
  readonly locale: string;
  /** The phrases of the plan and then of the page, each with the plural rules of its language. */
  readonly #sources: readonly (readonly [GivenPhrases, Intl.PluralRules])[];

  /** `given` are the phrases of the plan in this language, which have priority. */
  constructor(language: string, given: GivenPhrases = {}) {
    const ours = shippedIn(language);
    this.language = language;
    this.locale = ours || Object.keys(given).length > 0 ? language : 'en';
    this.#sources = [
      [given, new Intl.PluralRules(language)],
      [ours ?? english, new Intl.PluralRules(ours ? language : 'en')],
    ];
  }

  /** Returns a phrase with its placeholders filled in; braces in values are kept. */
  text = <Key extends PhraseKey>(key: Key, ...[values]: Values<Key>): string => {
    const filled: Readonly<Record<string, string | number>> = values ?? {};
    const [source, plurals] = this.#sources.find(([phrases]) => Object.hasOwn(phrases, key)) ?? [];
    const phrase = source?.[key] ?? '';
    const text =
      typeof phrase === 'string' ? phrase : (phrase[plurals?.select(Number(filled.count)) ?? 'other'] ?? phrase.other);
    return text.replace(/\{(\w+)\}/g, (gap, name: string) =>
      Object.hasOwn(filled, name) ? String(filled[name]) : gap,
    );
  };

  /** Formats a length [m] to a tenth: "1.2 m", "1,2 m". */
  metres(length: number): string {
    const digits = { minimumFractionDigits: 1, maximumFractionDigits: 1 };
    return this.text('metres', { length: new Intl.NumberFormat(this.locale, digits).format(length) });
  }

  /** Formats a list of names: "P02 and P03", "P02 und P03". */
  list(names: readonly string[]): string {
    return new Intl.ListFormat(this.locale).format(names);
  }
}

/** The languages and phrases of a study; `languages` absent: English only. */
export interface LanguageOptions {
  readonly languages?: readonly string[];
  readonly phrases?: Readonly<Record<string, GivenPhrases>>;
}

export const phrasesOf = ({ phrases = {} }: LanguageOptions, language: string): Phrases =>
  new Phrases(language, Object.hasOwn(phrases, language) ? phrases[language] : {});

/** An error for participants in their language; its message is in English. */
export class PhrasedError<Key extends PhraseKey = PhraseKey> extends Error {
  readonly #key: Key;
  readonly #values: Values<Key>;

  constructor(key: Key, ...values: Values<Key>) {
    super(new Phrases('en').text(key, ...values));
    this.#key = key;
    this.#values = values;
  }

  in(phrases: Phrases): string {
    return phrases.text(this.#key, ...this.#values);
  }
}
