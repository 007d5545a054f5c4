import type { Page } from '@playwright/test';
import { english } from '../../src/study/model/phrases/english';
import { enterVr, expect, keepPicture } from '../page-fixture';
import {
  calibrate,
  openResults,
  press,
  reaches,
  recordsOf,
  stretched,
  study,
  takePart,
  tenHertz,
  test,
} from './study-participant';
import { experimenter, shortStudy, withoutPractice } from './study-server';

/** The shipped example with questions of every kind, its times cut short. */
const shortExample = (id: string) => withoutPractice(shortStudy(id, 'example'));

/** What the page says in English in more than one word, each up to the first gap. */
const ofEnglish = Object.values(english)
  .flatMap((phrase) => (typeof phrase === 'string' ? [phrase] : Object.values(phrase)))
  .flatMap((phrase) => phrase.split(/\{\w+\}/))
  .map((part) => part.trim())
  .filter((part) => /\w{2,} \w{2,}/.test(part));

declare global {
  interface Window {
    /** What screens showed, and what the sheet of the headset drew. */
    read: Set<string>;
    /** The labels of buttons that were cut off. */
    cut: Set<string>;
  }
}

/** Keeps, from now on, what stands on the card and what is written on the sheet of the headset, which is a picture. */
const readScreens = (page: Page): Promise<void> =>
  page.evaluate(() => {
    window.read = new Set();
    window.cut = new Set();
    const { fillText } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function (text, x, y, most) {
      window.read.add(text);
      if (most === undefined) fillText.call(this, text, x, y);
      else fillText.call(this, text, x, y, most);
    };
    const read = () => {
      for (const card of document.querySelectorAll<HTMLElement>('.study-card')) {
        window.read.add(card.textContent);
        for (const { ariaLabel } of card.querySelectorAll('[aria-label]')) window.read.add(ariaLabel ?? '');
        for (const { scrollWidth, clientWidth, textContent } of card.querySelectorAll('button')) {
          if (scrollWidth > clientWidth + 1) window.cut.add(textContent);
        }
      }
    };
    new MutationObserver(read).observe(document.body, { subtree: true, childList: true, characterData: true });
  });

/** Consents, confirms the code and submits the demographic questions, in German. */
async function consentAndFillInInGerman(page: Page): Promise<void> {
  await expect(page.locator('.study-card')).toHaveAttribute('lang', 'de');
  await page.getByLabel(/Ich habe dies gelesen/).check();
  await page.getByRole('button', { name: 'Ich willige ein' }).click();
  await page.getByRole('button', { name: 'Ich habe ihn notiert' }).click();
  await page.getByLabel('Keine Angabe').check();
  await page.getByLabel(/Alter/).fill('12');
  await page.getByLabel(/Studienfach/).fill('Informatik');
  await page.getByLabel('Ein- oder zweimal').check();
  await page.getByLabel('Die rechte', { exact: true }).check();
  await page.getByLabel('Gut ohne Sehhilfe').check();
  await page.getByRole('button', { name: 'Weiter' }).click();
  await expect(page.getByRole('alert')).toHaveText('Bitte geben Sie Ihr Alter als ganze Zahl von 16 bis 120 an.');
  await page.getByLabel(/Alter/).fill('26');
  await page.getByRole('button', { name: 'Weiter' }).click();
}

/** Gives each of these ratings of NASA-TLX 35 and hands in after the last. */
async function rateAtDesk(page: Page, ratings: readonly string[]): Promise<void> {
  for (const [index, id] of ratings.entries()) {
    await reaches(page, `question-${id}`);
    await page.getByRole('radio', { name: '35' }).check();
    await page.getByRole('button', { name: index === ratings.length - 1 ? 'Abgeben' : 'Weiter' }).click();
  }
}

test('questions of every kind are answered alike in headset and at the desk, in German @full', async ({
  page,
  origin,
}) => {
  // Twenty presses in the headset, each some frames of a software renderer.
  test.setTimeout(480_000);
  await experimenter(origin).addStudy(shortExample('every-kind'), true);
  const headset = await takePart(page, origin, 'every-kind', 'P01');
  await page.getByLabel('Language').selectOption('de');
  await expect(page.getByRole('heading', { name: 'Teilnahme' })).toBeVisible();
  await readScreens(page);
  await keepPicture(page, 'study-consent-language');
  await consentAndFillInInGerman(page);

  await enterVr(page, tenHertz);
  await headset.place(stretched);
  await calibrate(page);
  await reaches(page, 'trial-ready');
  await press(page, 'start');
  await reaches(page, 'question-mine', 60_000);
  await press(page, 'answer-6');
  await keepPicture(page, 'study-question-likert');
  await press(page, 'next');
  await press(page, 'answer-2');
  await press(page, 'next');
  await press(page, 'answer-36');
  await press(page, 'more');
  await press(page, 'next');
  await press(page, 'answer-arms');
  await press(page, 'next');
  await press(page, 'key-3');
  await press(page, 'next');
  for (const key of ['key-o', 'key-k']) await press(page, key);
  await press(page, 'submit');
  await reaches(page, 'question-mental');
  await press(page, 'answer-35');
  await press(page, 'next');
  // What was begun in the headset goes on at the desk.
  await headset.endSession();
  await reaches(page, 'question-physical');
  await rateAtDesk(page, ['physical', 'temporal', 'performance', 'effort', 'frustration']);

  await enterVr(page, tenHertz);
  await headset.place(stretched);
  await reaches(page, 'trial-ready');
  await press(page, 'start');
  await reaches(page, 'question-mine', 60_000);
  await headset.endSession();
  await expect(page.getByText('Der virtuelle Körper fühlte sich wie mein eigener an.')).toBeVisible();
  await page.getByRole('radio', { name: '6' }).check();
  const next = page.getByRole('button', { name: 'Weiter' });
  await next.click();
  await page.getByRole('radio', { name: '2' }).check();
  await next.click();
  const line = page.getByRole('slider');
  await line.focus();
  await page.keyboard.press('Home');
  for (let steps = 0; steps < 37; steps++) await page.keyboard.press('ArrowRight');
  await next.click();
  await page.getByRole('radio', { name: 'Meine Arme' }).check();
  await next.click();
  const field = page.getByRole('textbox', { name: 'Antwort' });
  await field.fill('9');
  await expect(page.getByText('Bitte geben Sie eine ganze Zahl von 0 bis 4 ein.')).toBeVisible();
  await field.fill('3');
  await next.click();
  await field.pressSequentially('ok');
  await page.getByRole('button', { name: 'Abgeben' }).click();
  await reaches(page, 'question-mental');
  await rateAtDesk(page, ['mental', 'physical', 'temporal', 'performance', 'effort', 'frustration']);
  await reaches(page, 'end');
  await expect.poll(async () => (await study(page)).unsent).toBe(0);
  await keepPicture(page, 'study-end');
  const { read, cut } = await page.evaluate(() => ({ read: [...window.read], cut: [...window.cut] }));
  expect(cut).toEqual([]);
  const text = read.join('\n');
  for (const phrase of ['Weiter', 'Entspannen Sie Ihre Arme.']) expect(text).toContain(phrase);
  expect(ofEnglish.filter((phrase) => text.includes(phrase))).toEqual([]);

  const records = await recordsOf(origin, 'every-kind');
  const trials = records.flatMap((record) => (record.kind === 'trial' ? [record.body] : []));
  expect(trials.map(({ condition }) => condition).toSorted()).toEqual(['hands-only', 'learned']);
  for (const { condition, estimator } of trials) expect(estimator).toBe(condition);
  const answers = records.flatMap((record) => (record.kind === 'answers' ? [record.body] : []));
  expect(answers.map(({ questionnaire, language }) => [questionnaire, language])).toEqual([
    ['body', 'de'],
    ['nasa-tlx-raw', 'de'],
    ['body', 'de'],
    ['nasa-tlx-raw', 'de'],
  ]);
  // Answers are recorded as values that do not depend on the language.
  expect(records.find(({ kind }) => kind === 'demographics')?.body).toEqual({
    ...{ gender: 'not-said', age: 26, major: 'Informatik', vrExperience: 'once-or-twice', vrSystems: '' },
    ...{ handedness: 'right', vision: 'normal' },
  });
  const [inHeadset, begunInHeadset, atDesk, ratedAtDesk] = answers;
  expect(ratedAtDesk?.answers).toEqual(begunInHeadset?.answers);
  expect(inHeadset?.answers).toEqual({
    ...{ mine: 6, strange: 2, delay: 37, watched: 'arms', guess: 3, remarks: 'ok' },
  });
  expect(atDesk?.answers).toEqual(inHeadset?.answers);

  await openResults(page, 'every-kind');
  await expect(page.getByText('SIMULATED: a program made these data')).toBeVisible();
  await expect(page.getByRole('img', { name: /Archery: scores, means/ })).toBeVisible();
  await expect(page.getByRole('heading', { name: 'Scales' })).toBeVisible();
  await expect(page.getByRole('row', { name: /^Embodiment, Archery 1 6\.00/ })).toBeVisible();
  await page.screenshot({ path: 'artifacts/screenshots/study-scales.png', fullPage: true });
});
