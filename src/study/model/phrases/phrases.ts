import type { Catalogue, GivenPhrases, PhraseKey } from './catalogue';
import { english } from './english';
import { german } from './german';

type TextsOf<Said> = Said extends string ? Said : Said[keyof Said];
type NamesIn<Text> = Text extends `${string}{${infer Name}}${infer Rest}` ? Name | NamesIn<Rest> : never;
type Gap<Key extends PhraseKey> = NamesIn<TextsOf<(typeof english)[Key]>>;
/** A key of a phrase that nothing is filled into. */
export type PlainKey = { [Key in PhraseKey]: [Gap<Key>] extends [never] ? Key : never }[PhraseKey];
/** What is filled into a phrase: nothing, or a value for each of its gaps. */
export type Values<Key extends PhraseKey> = [Gap<Key>] extends [never]
  ? readonly []
  : readonly [{ readonly [Name in Gap<Key>]: Name extends 'count' ? number : string | number }];

export const phraseKeys = Object.keys(english) as readonly PhraseKey[];

/** What the page itself has, by language. */
export const shippedPhrases: Readonly<Record<string, Catalogue>> = { en: english, de: german };
/** The languages that the page itself has every phrase in. */
export const shippedLanguages = Object.keys(shippedPhrases) as readonly string[];

/** The names of the gaps in a text: "{count} of {total}" has count and total. */
export const gapsIn = (text: string): ReadonlySet<string> =>
  new Set([...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name as string));

/** de of de-AT. */
const baseOf = (language: string): string => language.split('-')[0] as string;

const shippedIn = (language: string): Catalogue | undefined =>
  shippedPhrases[language] ?? shippedPhrases[baseOf(language)];

/** The keys that neither the page nor these phrases of a plan give in a language: they are said in English. */
export const missingKeys = (language: string, given: GivenPhrases = {}): readonly PhraseKey[] =>
  shippedIn(language) ? [] : phraseKeys.filter((key) => !Object.hasOwn(given, key));

/** Of the languages offered the one that a reader wants most, the most wanted first; the first offered where none is. */
export function preferredLanguage(offered: readonly [string, ...string[]], wanted: readonly string[]): string {
  for (const want of wanted.map((one) => one.toLowerCase())) {
    const alike = (match: (language: string) => boolean) => offered.find((one) => match(one.toLowerCase()));
    const found = alike((one) => one === want) ?? alike((one) => baseOf(one) === baseOf(want));
    if (found !== undefined) return found;
  }
  return offered[0];
}

/** What the page says to participants, in one language. */
export class Phrases {
  /** The participant's. */
  readonly language: string;
  /** The language of what is said: English where the page has nothing in the participant's. */
  readonly spoken: string;
  /** Those of the plan, then those of the page, each with the plural rules of its language. */
  readonly #sources: readonly (readonly [GivenPhrases, Intl.PluralRules])[];

  /** `given`: the plan's own phrases in this language, which go before the page's. */
  constructor(language: string, given: GivenPhrases = {}) {
    const ours = shippedIn(language);
    this.language = language;
    this.spoken = ours || Object.keys(given).length > 0 ? language : 'en';
    this.#sources = [
      [given, new Intl.PluralRules(language)],
      [ours ?? english, new Intl.PluralRules(ours ? language : 'en')],
    ];
  }

  /** A phrase with its gaps filled in; what stands in braces in a value stays as it is. */
  say = <Key extends PhraseKey>(key: Key, ...[values]: Values<Key>): string => {
    const filled: Readonly<Record<string, string | number>> = values ?? {};
    const [source, plurals] = this.#sources.find(([phrases]) => Object.hasOwn(phrases, key)) ?? [];
    const phrase = source?.[key] ?? '';
    const text =
      typeof phrase === 'string' ? phrase : (phrase[plurals?.select(Number(filled.count)) ?? 'other'] ?? phrase.other);
    return text.replace(/\{(\w+)\}/g, (gap, name: string) =>
      Object.hasOwn(filled, name) ? String(filled[name]) : gap,
    );
  };

  /** A length [m] to a tenth: "1.2 m", "1,2 m". */
  metres(length: number): string {
    const digits = { minimumFractionDigits: 1, maximumFractionDigits: 1 };
    return this.say('metres', { length: new Intl.NumberFormat(this.spoken, digits).format(length) });
  }

  /** Names in a row: "P02 and P03", "P02 und P03". */
  list(names: readonly string[]): string {
    return new Intl.ListFormat(this.spoken).format(names);
  }
}

/** A study as far as its languages go; `languages` absent: English alone. */
export interface Speaking {
  readonly languages?: readonly string[];
  readonly phrases?: Readonly<Record<string, GivenPhrases>>;
}

/** What the page says in a study to those who read this language. */
export const phrasesOf = ({ phrases = {} }: Speaking, language: string): Phrases =>
  new Phrases(language, Object.hasOwn(phrases, language) ? phrases[language] : {});

/** An error for participants to read in their language; its message is the English of it. */
export class PhrasedError<Key extends PhraseKey = PhraseKey> extends Error {
  readonly #key: Key;
  readonly #values: Values<Key>;

  constructor(key: Key, ...values: Values<Key>) {
    super(new Phrases('en').say(key, ...values));
    this.#key = key;
    this.#values = values;
  }

  in(phrases: Phrases): string {
    return phrases.say(this.#key, ...this.#values);
  }
}
