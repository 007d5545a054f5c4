import type { Page } from '@playwright/test';
import type { StudyPlan } from '../../src/study/model/plan/plan';
import type { StudyRecord } from '../../src/study/model/records/study-record';
import type { StudyProbe } from '../../src/study/participant/study-run';
import { type EmulatedHeadset, emulatedHeadset } from '../emulated-headset';
import { expect, freshTest as pageTest } from '../page-fixture';
import { experimenter, experimenterToken, serveStudies } from './study-server';

export const test = pageTest.extend<object, { origin: string }>({
  origin: [
    // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
    async ({}, use) => {
      const server = await serveStudies();
      await use(server.origin);
      await server.close();
    },
    { scope: 'worker' },
  ],
});

declare global {
  interface Window {
    /** Set by a test: the page draws twice a second. */
    resting?: boolean;
  }
}

export const study = (page: Page): Promise<StudyProbe> =>
  page
    .waitForFunction(() => window.threepoint?.probe().study)
    .then((shown) => shown.jsonValue() as Promise<StudyProbe>);

export const screen = async (page: Page) => (await study(page)).screen;
export const reaches = (page: Page, id: string, timeout = 20_000) =>
  expect.poll(() => screen(page), { timeout, intervals: [100] }).toBe(id);

export const upright = [0, 0, 0, 1] as const;
export const stretched = {
  head: { position: [0, 1.7, 0], orientation: upright },
  left: { position: [-0.19, 1.4, -0.6], orientation: upright },
  right: { position: [0.19, 1.4, -0.6], orientation: upright },
} as const;

/**
 * Points the right controller's ray at a target of the sheet, waits until it is highlighted and pulls the trigger.
 * `leave` returns the arms to the calibration pose before the trigger is released. It all runs inside the page, because
 * on a slow machine each call into the page costs a frame.
 */
export const press = (page: Page, id: string, leave = false): Promise<void> =>
  page.evaluate(
    async ([id, upright, leave]) => {
      const frame = () => new Promise<void>((resolve) => requestAnimationFrame(() => resolve()));
      const until = async <T>(look: () => T | undefined | false): Promise<T> => {
        for (const end = Date.now() + 60_000; Date.now() < end; ) {
          const seen = look();
          if (seen) return seen;
          await frame();
        }
        throw new Error(`"${id}" cannot be pressed on the screen "${window.threepoint?.probe().study?.screen}"`);
      };
      const study = () => window.threepoint?.probe().study;
      const { right, left } = window.emulatedDevice.controllers;
      window.emulatedDevice.controlMode = 'programmatic';
      window.emulatedDevice.position.set(0, 1.7, 0);
      const aimed = () => {
        const at = study()?.targets.find((target) => target.id === id)?.at;
        if (at) right.position.set(at[0], at[1], at[2] + 0.35);
        return at !== undefined;
      };
      await until(aimed);
      left.position.set(-0.19, 1.4, -0.6);
      for (const hand of [left, right]) {
        hand.quaternion.set(...upright);
        // The built-in archer may hold the bow drawn when its round ends: a trigger that is held cannot be pulled.
        hand.updateButtonValue('trigger', 0);
      }
      // The ray may be on the target already: one frame must see the trigger released.
      await frame();
      // The sheet follows the user's head when they have just stood up.
      await until(() => aimed() && study()?.pointedAt === id);
      const before = JSON.stringify(study()?.screen);
      right.updateButtonValue('trigger', 1);
      for (let i = 0; i < 3; i++) await frame();
      if (leave) {
        await until(() => JSON.stringify(study()?.screen) !== before);
        right.position.set(0.19, 1.4, -0.6);
      }
      right.updateButtonValue('trigger', 0);
      for (let i = 0; i < 2; i++) await frame();
    },
    [id, upright, leave] as const,
  );

export async function takePart(page: Page, origin: string, id: string, participant: string): Promise<EmulatedHeadset> {
  await page.goto(await experimenter(origin).link(id, participant, '&emulate&quality=low'));
  return headsetOf(page);
}

export async function headsetOf(page: Page): Promise<EmulatedHeadset> {
  await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, { timeout: 60_000 });
  return emulatedHeadset(page);
}

/**
 * Opens the page at a step of a study without a headset, as another device that continues a session. It is the first
 * participant's, who has consented before.
 */
export async function continueAtDesk(page: Page, origin: string, plan: StudyPlan, step: string): Promise<void> {
  const experimenting = experimenter(origin);
  await experimenting.addStudy(plan, false);
  await experimenting.consented(plan, 'P01');
  await experimenting.report(plan, 'P01', step);
  await experimenting.release(plan.id, 'P01');
  await page.goto(await experimenting.link(plan.id, 'P01', '&quality=low'));
  await page.getByLabel(/I have read this/).check();
  await page.getByRole('button', { name: 'I agree' }).click();
}

/** Fills in the demographic questions; does not submit them. */
export async function fillInDemographics(page: Page): Promise<void> {
  await page.getByLabel('I prefer not to say').check();
  await page.getByLabel(/Age/).fill('26');
  await page.getByLabel(/Field of study/).fill('Computer science');
  await page.getByLabel('Once or twice').check();
  await page.getByLabel('Right', { exact: true }).check();
  await page.getByLabel('Well without correction').check();
}

/** Consents, confirms the withdrawal code and submits the demographic questions. */
export async function consentAndFillIn(page: Page): Promise<void> {
  await page.getByLabel(/I have read this/).check();
  await page.getByRole('button', { name: 'I agree' }).click();
  await page.getByRole('button', { name: 'I have noted it' }).click();
  await fillInDemographics(page);
  await page.getByRole('button', { name: 'Continue' }).click();
}

export async function calibrate(page: Page): Promise<void> {
  await reaches(page, 'calibration');
  await press(page, 'calibrate', true);
  // Five seconds of the page's time are fifty frames, which may take long on a slow machine.
  await expect.poll(() => screen(page), { intervals: [100], timeout: 90_000 }).toMatch(/-(ready|failed)$/);
  expect(await screen(page)).toMatch(/-ready$/);
}

/** The step for questionnaires and rounds, which need few frames: each frame redraws the sheet. */
export const tenHertz = { stepMs: 100 };

export const recordsOf = async (origin: string, id: string): Promise<readonly StudyRecord[]> =>
  (await experimenter(origin).records(id)).records;

export async function signIn(page: Page): Promise<void> {
  await page.getByLabel('Token').fill(experimenterToken);
  await page.getByRole('button', { name: 'Open' }).click();
}

/** Opens a study on the experimenter's page or on that of the results. */
export async function openStudy(page: Page, address: string, id: string): Promise<void> {
  await page.goto(address);
  await signIn(page);
  await page.getByRole('combobox', { name: 'Study' }).selectOption(id);
}

export const openResults = (page: Page, id: string): Promise<void> => openStudy(page, '/results', id);
