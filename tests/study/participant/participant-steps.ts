import { expect } from 'vitest';
import { aWomanOf26 } from '../model/studies';
import { browser, type Tab } from './study-browser';
import type { StudyServer } from './study-server';

export async function agree(tab: Tab, motion = false): Promise<void> {
  expect(await tab.display.asked('consent').agree({ motion, language: null })).toBeNull();
  tab.display.asked('code').noted();
}

/** With the headset on, the participant is measured; the practice is loaded then. */
export async function measure(tab: Tab): Promise<void> {
  tab.wear(true);
  tab.display.press('calibrate');
  tab.draw(6);
  await canStart(tab);
}

export function canStart(tab: Tab): Promise<void> {
  tab.display.wait();
  return tab.display.until(
    ({ screen }) => screen?.buttons.some(({ id, look }) => id === 'start' && look === 'primary') ?? false,
  );
}

/** The practice or round that waits, from the start to its end. */
export function play(tab: Tab, points: number): void {
  tab.display.press('start');
  tab.draw(1);
  tab.host.games.archery.hit(points);
  tab.draw(3);
}

/** P01 in the headset before the first round, measured and practised. */
export async function beforeTheRound(server: StudyServer, motion = false, storageLimitMs?: number) {
  const device = browser(server, storageLimitMs);
  const tab = await device.open();
  await agree(tab, motion);
  expect(tab.display.asked('demographics').done(aWomanOf26)).toBeNull();
  await measure(tab);
  play(tab, 10);
  await canStart(tab);
  expect(tab.visit.state().step).toBe('archery/1/trial-1');
  return { device, tab };
}

/** A participant who has played the round and sits before its questions, the headset on. */
export async function beforeTheQuestions(server: StudyServer, storageLimitMs?: number) {
  const visit = await beforeTheRound(server, false, storageLimitMs);
  play(visit.tab, 40);
  expect(visit.tab.display.shown).toBe('rest');
  visit.tab.pass(61);
  expect(visit.tab.display.shown).toBe('question-Q1');
  return visit;
}

/** Gives the question shown an answer of its scale. */
export function choose({ display }: Tab, value: number): void {
  const field = display.screen?.question?.field;
  if (field?.kind !== 'likert') throw new Error(`expected a Likert scale on "${display.shown}"`);
  field.choose(value);
}

/** Gives the seven questions after a round the same answer and submits them. */
export function handIn(tab: Tab, value: number): void {
  for (let index = 1; index <= 7; index++) {
    expect(tab.display.shown).toBe(`question-Q${index}`);
    choose(tab, value);
    tab.display.press(index < 7 ? 'next' : 'submit');
  }
}
