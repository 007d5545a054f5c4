import type { Page } from '@playwright/test';
import { strFromU8, unzipSync } from 'fflate';
import { csvRows } from '../../src/study/cli/verify/csv-rows';
import { verifyExport } from '../../src/study/cli/verify/verify-export';
import type { StudyPlan } from '../../src/study/model/plan/plan';
import { frames } from '../emulated-headset';
import { expect, keepPicture } from '../page-fixture';
import { loadAgain, openGroup, patience, people, pressOnAll, rest } from './group-pages';
import { press, reaches, recordsOf, screen, study, test } from './study-participant';
import { experimenter, shortStudy, withoutPractice } from './study-server';

/**
 * The match stands longer than any page takes to draw what has happened [s]: for so many pictures, of which each takes
 * half a second.
 */
const standsSeconds = 15;
const standsPictures = 2 * standsSeconds + 1;
/** The duration of a match [s], as in the paper. It is long enough for an experimenter's command on a busy machine. */
const matchSeconds = 90;

// Three headsets in software rendering take minutes.
test('three participants play the ball game together, each in a headset of their own @nightly', async ({
  browser,
  origin,
}) => {
  test.setTimeout(900_000);
  await experimenter(origin).addStudy(withoutPractice(shortStudy('trio', 'paper', 'ball', matchSeconds)), true);
  const pages = await openGroup(browser, origin, 'trio');
  const all = <T>(act: (page: Page, index: number) => Promise<T>) => Promise.all(pages.map(act));
  const [first, second, third] = pages;
  await pressOnAll(pages, 'start', async (page) => {
    if (page !== third) await reaches(page, 'waiting', 60_000);
  });
  // Two pictures a second are enough to see how a match goes on: all three rest until it is over.
  await expect.poll(async () => (await all(study)).map(({ running }) => running), patience).toEqual([true, true, true]);

  // The experimenter pauses one of them: the match stands for all three.
  const match = (page: Page) => page.evaluate(() => window.threepoint?.probe().game);
  const clocks = () => all(async (page) => ((await match(page)) as { secondsLeft: number }).secondsLeft);
  const command = (type: 'pause' | 'resume') => experimenter(origin).command('trio', 'P02', { type });
  await command('pause');
  await expect.poll(() => all(screen), patience).toEqual(['standing', 'paused', 'standing']);
  await keepPicture(first, 'study-standing');
  await keepPicture(second, 'study-paused');
  const stand = await clocks();
  await all((page) => frames(page, standsPictures));
  expect(await clocks()).toEqual(stand);
  expect(Math.max(...stand)).toBeGreaterThan(0);
  await command('resume');
  await expect.poll(() => all(screen), patience).toEqual(['playing', 'playing', 'playing']);

  await all((page) => expect.poll(() => screen(page), { timeout: 240_000 }).toMatch(/^(rest|question-Q8)$/));
  await all((page) => expect.poll(async () => (await study(page)).unsent).toBe(0));

  const trials = (await recordsOf(origin, 'trio')).filter((record) => record.kind === 'trial');
  expect(trials.map(({ participant }) => participant).toSorted()).toEqual([...people]);
  // One group, one condition.
  expect(new Set(trials.map(({ body }) => body.condition)).size).toBe(1);
  expect(new Set(trials.map(({ body }) => body.group))).toEqual(new Set([1]));
  for (const { body } of trials) {
    expect(body.outcome.maximum).toBe(20);
    expect(body.outcome.ended).toBe('time');
    // All of the match, to what a page knows of the room's clock, and no second of the pause: had it counted, the
    // outcome would be as much longer, however late a page draws the end.
    expect(body.outcome.seconds).toBeGreaterThan(matchSeconds - 1);
    expect(body.outcome.clock?.pauses).toHaveLength(1);
    expect(body.outcome.clock?.pauses[0]?.seconds).toBeGreaterThan(standsSeconds);
    expect(body.outcome.seconds).toBeLessThan(matchSeconds + standsSeconds);
  }
  await all((page) => page.context().close());
});

/** Two blocks of short ball matches with one question after each; a match waits two minutes for who is away. */
function sessionPlan(): StudyPlan {
  const plan = withoutPractice(shortStudy('session', 'paper', 'ball', 30));
  const enjoyed = { id: 'enjoyed', text: 'I enjoyed it.' };
  const ends = { low: 'Not at all', high: 'Very much' };
  return {
    ...plan,
    questionnaires: [
      {
        ...{ id: 'short', title: 'One question', scales: [], questions: [enjoyed] },
        answer: { kind: 'likert', from: 1, to: 7, ends },
      },
    ],
    tasks: plan.tasks.map((task) => ({
      ...task,
      calibrateBeforeBlock: false,
      questionnaire: 'short',
      absence: { waitSeconds: 120, after: 'repeat' },
    })),
  };
}

/** Sockets of a page whose messages can be delayed, as by a network that is lost for a while. */
function delayedSockets() {
  const waiting: (() => void)[] = [];
  let isLost = false;
  const carry = (send: () => void) => {
    if (isLost) waiting.push(send);
    else send();
  };
  return {
    route: (page: Page) =>
      page.routeWebSocket(/.*/, (client) => {
        const server = client.connectToServer();
        client.onMessage((message) => carry(() => server.send(message)));
        server.onMessage((message) => carry(() => client.send(message)));
      }),
    lose() {
      isLost = true;
    },
    mend() {
      isLost = false;
      for (const send of waiting.splice(0)) send();
    },
  };
}

/** Returns the rows of a table of an export as objects. */
function rowsIn(zip: Uint8Array, name: string): readonly Readonly<Record<string, string>>[] {
  const files = unzipSync(zip);
  const path = Object.keys(files).find((one) => one.endsWith(`/${name}.csv`)) as string;
  const [heads = [], ...rows] = csvRows(strFromU8(files[path] as Uint8Array));
  return rows.map((cells) => Object.fromEntries(heads.map((head, index) => [head, cells[index] ?? ''])));
}

test('three participants’ tables state a reload, a lost network, a void and a withdrawal @nightly', async ({
  browser,
  origin,
}) => {
  test.setTimeout(900_000);
  const experimenting = experimenter(origin);
  await experimenting.addStudy(sessionPlan(), true);
  const network = delayedSockets();
  let withdrawalCode = '';
  const pages = await openGroup(browser, origin, 'session', async (page, participant) => {
    if (participant !== 'P03') return;
    await network.route(page);
    page.on('response', async (response) => {
      if (response.url().endsWith('/claim')) ({ withdrawalCode } = await response.json());
    });
  });
  const [first, second] = pages;
  const screens = () => Promise.all(pages.map(screen));
  const startAll = async () => {
    await pressOnAll(pages, 'start');
    await expect.poll(screens, patience).toEqual(['playing', 'playing', 'playing']);
  };
  const answerAll = async (next: string) => {
    for (const page of pages) await reaches(page, 'question-enjoyed', 120_000);
    await pressOnAll(pages, 'answer-5');
    await pressOnAll(pages, 'submit', (page) => reaches(page, next, 60_000));
  };

  // Block 1: the second page is loaded again, then the third loses its network.
  await startAll();
  await rest(second, false);
  await loadAgain(second);
  await expect.poll(() => screen(first), patience).toBe('standing');
  await keepPicture(first, 'study-waits-for-reload');
  await press(second, 'start');
  await rest(second, true);
  await expect.poll(screens, patience).toEqual(['playing', 'playing', 'playing']);
  network.lose();
  await expect.poll(() => screen(first), patience).toBe('standing');
  network.mend();
  await answerAll('trial-ready');

  // Block 2: the experimenter voids it in its match, and it is played again.
  await startAll();
  for (const participant of people) {
    const command = { type: 'void-block', reason: 'the phone rang', repeat: true } as const;
    await experimenting.command('session', participant, command);
  }
  for (const page of pages) await reaches(page, 'trial-ready', 60_000);
  await keepPicture(first, 'study-voided');
  await startAll();
  await answerAll('end');
  await Promise.all(pages.map((page) => expect.poll(async () => (await study(page)).unsent, patience).toBe(0)));

  const zipOf = async () => new Uint8Array(await (await experimenting.export('session')).zip.arrayBuffer());
  const zip = await zipOf();
  expect(verifyExport(zip).problems).toEqual([]);
  const trials = rowsIn(zip, 'trials');
  const [block1, block2] = ['1', '2'].map((block) => trials.filter((row) => row.block === block));
  expect(block1).toHaveLength(3);
  // A page that the machine holds up for long is absent too.
  const absences = block1?.[0]?.absences?.split('; ') ?? [];
  for (const participant of ['P02', 'P03'])
    expect(absences.join()).toMatch(new RegExp(`${participant}.*: \\d+\\.\\d s at`));
  for (const row of block1 ?? []) {
    expect(row.absences?.split('; ')).toEqual(absences);
    if (row.participant === 'P02') expect(row.excluded).toMatch(/^incomplete: recorded from second/);
    else expect([row.excluded, row.ended, row.attempt]).toEqual(['', 'time', '1']);
  }
  expect(block2?.map(({ run, excluded }) => [run, excluded])).toEqual(people.map(() => ['2', '']));
  const events = rowsIn(zip, 'events');
  const counts = (name: string) => events.filter(({ event }) => event === name).length;
  expect([counts('void-block'), counts('interrupted')]).toEqual([3, 1]);
  expect(counts('absence')).toBeGreaterThanOrEqual(3 * absences.length);
  expect(new Set(rowsIn(zip, 'answers').map(({ participant }) => participant))).toEqual(new Set(people));

  // The third participant withdraws; what the others played stays.
  expect((await experimenting.ask('/session/withdraw', 'POST', { code: withdrawalCode })).status).toBe(200);
  const remaining = await zipOf();
  expect(new Set(rowsIn(remaining, 'trials').map(({ participant }) => participant))).toEqual(new Set(['P01', 'P02']));
  expect(verifyExport(remaining).problems).toEqual([]);
  await Promise.all(pages.map((page) => page.context().close()));
});
