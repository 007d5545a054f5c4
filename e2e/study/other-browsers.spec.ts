import { readFileSync } from 'node:fs';
import { parsePlan } from '../../src/study/model/plan/plan';
import { buttonPath, inBrowser, isInstalled, otherBrowsers } from '../other-browser';
import { expect } from '../page-fixture';
import { recordsOf, test } from './study-participant';
import { experimenter } from './study-server';

for (const name of otherBrowsers) {
  test.describe(name, () => {
    // biome-ignore lint/suspicious/noSkippedTests: reason: a program that the suite's name mentions is missing
    test.skip(!isInstalled(name), `${name} is not installed`);
    test.beforeEach(() => test.setTimeout(600_000));

    test(`a participant consents to a study in ${name} @nightly`, ({ origin }) =>
      inBrowser(name, async (browser) => {
        const experimenting = experimenter(origin);
        const id = `consent-${name.toLowerCase()}`;
        const example = parsePlan(readFileSync('public/studies/example.json', 'utf8'), 'example.json');
        await experimenting.addStudy({ ...example, id }, false);
        await browser.open(await experimenting.link(id, 'P01', '&quality=low'));
        await browser.click('//label[contains(., "I have read this")]');
        await browser.click(buttonPath('I agree'));
        const kinds = async () => (await recordsOf(origin, id)).map(({ kind }) => kind);
        await expect.poll(kinds, { timeout: 120_000 }).toContain('consent');
      }));
  });
}
