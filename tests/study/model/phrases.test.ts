import { readdirSync, readFileSync } from 'node:fs';
import { describe, expect, test } from 'vitest';
import { english, type Phrase } from '../../../src/study/model/phrases/english';
import {
  missingKeys,
  PhrasedError,
  Phrases,
  phraseKeys,
  phrasesOf,
  placeholdersIn,
  preferredLanguage,
  shippedPhrases,
} from '../../../src/study/model/phrases/phrases';
import { checkedPlan } from '../../../src/study/model/plan/plan';
import { remarksOn } from '../../../src/study/model/plan/plan-remarks';
import { examplePlan, planComplaints } from './studies';

const german = shippedPhrases.de!;

const formsOf = (phrase: Phrase): readonly string[] => (typeof phrase === 'string' ? [phrase] : Object.values(phrase));

/** The example plan with French; its own texts are equal in all languages. */
function frenchPlan(phrases: object) {
  const plan = examplePlan();
  return {
    ...plan,
    languages: ['fr'],
    title: 'Deux avatars',
    questionnaires: undefined,
    tasks: plan.tasks.map((task) => ({ ...task, title: 'Tir à l’arc', questionnaire: 'nasa-tlx-raw' })),
    consent: { version: '1', title: 'Participation', paragraphs: ['Vous participez.'], motion: null },
    phrases,
  };
}
const complaintsOf = (phrases: object) => planComplaints(JSON.stringify(frenchPlan(phrases)), 'mine.json');
const planOf = (phrases: object) => checkedPlan(JSON.parse(JSON.stringify(frenchPlan(phrases))));

describe('a sentence with a name that is filled in', () => {
  test('has no article before it in English or German, because the article depends on the name', () => {
    const article = /\b(an?|eine?[mnrs]?) \{/i;
    for (const phrases of [english, german]) {
      for (const key of phraseKeys) for (const text of formsOf(phrases[key])) expect(text).not.toMatch(article);
    }
    // The names that follow an article: "left" or "right", "whole" or nothing, "participant" or "pair".
    const known = [
      'threepoint/core/body/calibration.ts',
      'study/model/questionnaires/kinds/number.ts',
      'study/pages/results/charts.tsx',
    ];
    const sources = new URL('../../../src/', import.meta.url);
    const files = readdirSync(sources, { recursive: true, encoding: 'utf8' }).filter((file) => /\.tsx?$/.test(file));
    expect(files.length).toBeGreaterThan(100);
    const found = files.filter((file) => /\ban? \$\{/i.test(readFileSync(new URL(file, sources), 'utf8')));
    expect(found.toSorted()).toEqual(known.toSorted());
  });
});

describe('the German of the page', () => {
  test('has every phrase, none of them empty or left in English', () => {
    expect(Object.keys(german).toSorted()).toEqual(Object.keys(english).toSorted());
    for (const key of phraseKeys) for (const text of formsOf(german[key])) expect(text.trim()).not.toBe('');
    const alike = phraseKeys.filter((key) => JSON.stringify(german[key]) === JSON.stringify(english[key]));
    expect(alike).toEqual(['pause', 'start', 'metres']);
  });

  test.each(phraseKeys)('%s has the gaps that the English has', (key) => {
    const wanted = placeholdersIn(formsOf(english[key]).at(-1) as string);
    for (const form of [...formsOf(english[key]), ...formsOf(german[key])])
      expect(placeholdersIn(form)).toEqual(wanted);
  });

  test('has the forms that the plural rules of the language ask for', () => {
    for (const [language, catalogue] of Object.entries({ en: english, de: german })) {
      const asked = new Intl.PluralRules(language).resolvedOptions().pluralCategories.toSorted();
      for (const phrase of Object.values(catalogue)) {
        if (typeof phrase !== 'string') expect(Object.keys(phrase).toSorted()).toEqual(asked);
      }
    }
  });

  test('counts, measures and lists as German does', () => {
    const phrases = new Phrases('de-AT');
    const { text } = phrases;
    expect(text('receipt.records', { count: 1 })).toBe('1 Eintrag');
    expect(text('receipt.records', { count: 0 })).toBe('0 Einträge');
    expect(phrases.metres(1.2)).toBe('1,2 m');
    expect(phrases.list(['P02', 'P03'])).toBe('P02 und P03');
    expect(new PhrasedError('round.archery').in(phrases)).toBe(german['round.archery']);
    expect(new PhrasedError('round.archery').message).toBe(english['round.archery']);
  });
});

describe('a plan with phrases of its own', () => {
  test('has its own first, and English where it has none', () => {
    const plan = planOf({
      fr: { next: 'Suivant', 'receipt.records': { one: '{count} réponse', other: '{count} réponses' } },
    });
    const { text, locale } = phrasesOf(plan, 'fr');
    expect(locale).toBe('fr');
    expect(text('next')).toBe('Suivant');
    expect(text('back')).toBe('Back');
    // French counts none as one, English as many: each phrase is counted by its own language.
    expect(text('receipt.records', { count: 0 })).toBe('0 réponse');
    expect(text('receipt.recordings', { count: 0 })).toBe('0 recordings of movements');
    expect(missingKeys('fr', plan.phrases?.fr)).toHaveLength(phraseKeys.length - 2);
    expect(remarksOn(plan).join(' ')).toContain(`lacks ${phraseKeys.length - 2} of ${phraseKeys.length} phrases`);
  });

  test('may say in German or English what suits the laboratory better', () => {
    const plan = { ...examplePlan(), phrases: { de: { next: 'Nächste Frage' } } };
    expect(phrasesOf(checkedPlan(plan), 'de').text('next')).toBe('Nächste Frage');
    expect(phrasesOf(checkedPlan(plan), 'de').text('back')).toBe('Zurück');
    expect(remarksOn(checkedPlan(plan)).join(' ')).not.toContain('phrases');
  });

  test('without a word in a language speaks English, and says so to screen readers', () => {
    expect(phrasesOf(planOf({}), 'fr')).toMatchObject({ language: 'fr', locale: 'en' });
    const all = Object.fromEntries(phraseKeys.map((key) => [key, english[key]]));
    expect(remarksOn(planOf({ fr: all })).join(' ')).not.toContain('phrases');
  });

  test.each<[object, string]>([
    [{ fr: { nxt: 'Suivant' } }, 'phrases.fr.nxt: is not known here'],
    [{ fr: { 'rest.titel': 'Pause' } }, 'phrases.fr["rest.titel"]: is not known here'],
    [{ fr: { round: 'Manche' } }, 'phrases.fr["round"]: lacks {number}'],
    [
      { fr: { round: 'Manche {number} de {total}' } },
      'phrases.fr["round"]: {total} stays empty: only {number} is filled in here',
    ],
    [{ fr: { next: '{suivant}' } }, 'phrases.fr["next"]: {suivant} stays empty: nothing is filled in here'],
    [
      { fr: { 'receipt.records': { one: 'une réponse', other: 'des réponses' } } },
      'phrases.fr["receipt.records"].other: lacks {count}',
    ],
    [
      { fr: { 'receipt.records': { one: '{count} réponse' } } },
      'phrases.fr["receipt.records"]: expected text, or its plural forms',
    ],
    [{ fr: { next: { other: 'Suivant' } } }, 'phrases.fr.next: expected text'],
    [{ fr: { next: '' } }, 'phrases.fr.next: expected text, found none'],
    [{ it: { next: 'Avanti' } }, 'phrases.it: the study is not in this language: expected one of fr'],
    [{ French: { next: 'Suivant' } }, 'expected a language'],
    [
      { fr: { 'keys.rows': 'azertyuiopqsdf ghjklm' } },
      'phrases.fr["keys.rows"]: expected at most 4 rows of at most 12 letters',
    ],
  ])('%j is refused with file, path and reason', (phrases, complaint) => {
    const [first, ...others] = complaintsOf(phrases);
    expect(first).toMatch(/^mine\.json: /);
    expect(first).toContain(complaint);
    expect(others).toEqual([]);
  });
});

test('a browser is read for the language that it wants most among those offered', () => {
  expect(preferredLanguage(['en', 'de'], ['de-AT', 'en'])).toBe('de');
  expect(preferredLanguage(['en', 'pt-BR'], ['PT', 'en'])).toBe('pt-BR');
  expect(preferredLanguage(['de', 'en'], ['fr', 'en-GB'])).toBe('en');
  expect(preferredLanguage(['de', 'en'], ['fr'])).toBe('de');
  expect(preferredLanguage(['de', 'en'], [])).toBe('de');
});
