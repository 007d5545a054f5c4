import { appendFileSync, mkdirSync, writeFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { fileURLToPath } from 'node:url';
import { type CDPSession, expect, type Page } from '@playwright/test';
import { printFigures } from '../../tests/print-figures';
import { memoryOf } from '../browser-processes';
import { freePort } from '../free-port';
import { countsOf, type InspectedNode, inspectNode, megabytes } from '../memory-usage';
import { probe } from '../page-fixture';
import { bar, expectVoices, loudness, type Talker, test, voicesOf } from '../talkers';

/**
 * The duration of talk and play [min]; THREEPOINT_SOAK_MINUTES lengthens it. A shorter run would measure compilation:
 * code compiled in the first four minutes takes 1 MB of a page's heap.
 */
const minutes = Number(process.env.THREEPOINT_SOAK_MINUTES ?? 10);
/** One person mutes and unmutes so often, */
const mutesAMinute = 5;
/** and the other leaves the voices and joins them again this often [minutes]. */
const rejoinEvery = 5;

/** The file with a line of figures for each minute, which remains if a run breaks. */
const file = fileURLToPath(new URL('../../artifacts/soak.jsonl', import.meta.url));

// A trace would keep each of the test's questions for hours, and film nothing that is looked at.
test.use({ trace: 'off' });

/** What a page holds after a collection. */
interface PageHolds {
  /** Objects and compiled code [MB]. */
  readonly heap: number;
  /** All processes of its browser [MB]: graphics, audio and network have theirs there. */
  readonly browser: number;
  readonly nodes: number;
  readonly listeners: number;
  /** Connections to others. */
  readonly connections: number;
  /** Nodes of all audio contexts. */
  readonly audioNodes: number;
  readonly geometries: number;
  readonly textures: number;
}

/** What was seen at the end of a minute. */
interface Minute {
  readonly minute: number;
  readonly ann: PageHolds;
  readonly ben: PageHolds;
  readonly server: { readonly heap: number; readonly all: number };
  /** Matches begun since the start, and the voices at the ears of both [dB of full scale]. */
  readonly matches: number;
  readonly loudness: readonly [ann: number, ben: number];
  /** Frames of Ann's page since it opened. */
  readonly frames: number;
  /** How often the room has taken each in: more than once where a connection was lost. */
  readonly welcomes: readonly [ann: number | undefined, ben: number | undefined];
}

async function holdsOf({ page, pid }: Talker, cdp: CDPSession): Promise<PageHolds> {
  const count = await countsOf(cdp);
  const { geometries, textures } = (await probe(page)).drawing;
  return {
    heap: megabytes(count('JSHeapUsedSize')),
    browser: memoryOf(pid),
    nodes: count('Nodes'),
    listeners: count('JSEventListeners'),
    connections: count('RTCPeerConnections'),
    audioNodes: count('AudioHandlers'),
    geometries,
    textures,
  };
}

/** Reads what both pages and the server hold, now. */
async function reader(people: readonly [Talker, Talker], server: InspectedNode, begun: number) {
  const sessions: CDPSession[] = [];
  for (const { page } of people) {
    const cdp = await page.context().newCDPSession(page);
    await cdp.send('Performance.enable');
    sessions.push(cdp);
  }
  const [ann, ben] = people;
  const [annCdp, benCdp] = sessions as [CDPSession, CDPSession];
  return async (): Promise<Minute> => ({
    minute: (Date.now() - begun) / 60_000,
    ann: await holdsOf(ann, annCdp),
    ben: await holdsOf(ben, benCdp),
    server: await server.memory(),
    matches: await ann.page.evaluate(() => window.soakMatches ?? 0),
    loudness: [await loudness(ann.page, 3), await loudness(ben.page, 3)],
    frames: (await probe(ann.page)).frame.count,
    welcomes: [(await voices(ann.page)).welcomes, (await voices(ben.page)).welcomes],
  });
}

/** Presses Ready for each match and counts those that begin, in the page: it sees each of its own frames. */
const playMatches = (page: Page) =>
  page.evaluate(() => {
    let was = '';
    window.soakMatches = 0;
    setInterval(() => {
      const game = window.threepoint?.probe().game;
      const phase = game?.name === 'ball' ? game.phase : was;
      if (phase === 'running' && was !== phase) window.soakMatches = (window.soakMatches ?? 0) + 1;
      was = phase;
      const button = [...document.querySelectorAll('button')].find(({ textContent }) =>
        /^(Ready|Play again)$/.test(textContent),
      );
      if (button?.checkVisibility()) button.click();
    }, 1000);
  });

const median = (values: readonly number[]): number =>
  [...values].sort((a, b) => a - b)[values.length >> 1] ?? Number.NaN;

/**
 * How a figure stood in the second quarter of a run, and in the last: what was warming up is over, and one odd minute
 * does not count.
 */
function quarters(run: readonly Minute[], of: (minute: Minute) => number): readonly [second: number, last: number] {
  const quarter = Math.ceil(run.length / 4);
  return [median(run.slice(quarter, 2 * quarter).map(of)), median(run.slice(-quarter).map(of))];
}

/** Joins the voices and unmutes, by keys: there is little to be seen of the page. */
async function join(page: Page): Promise<void> {
  for (const name of ['Talk with the others', 'Join, muted', 'Unmute me (T)'])
    await bar(page).getByRole('button', { name, exact: true }).press('Enter');
}

/** How a page takes part itself, and how it stands with its room and with the other person. */
async function voices(page: Page) {
  const { phase, muted, message, people } = await voicesOf(page);
  const other = people.find(({ voice }) => voice !== 'none');
  const { game, frame } = await probe(page);
  const { connection, welcomes } = game?.name === 'ball' ? game : {};
  return { phase, muted, message, connection, welcomes, frames: frame.count, link: other?.link, other: other?.voice };
}

type SeenVoices = Awaited<ReturnType<typeof voices>>;

/** Waits until these pages see this of the voices; rejects with all that they saw instead. */
async function seen(pages: readonly Page[], expected: Partial<SeenVoices>[]): Promise<void> {
  let now: SeenVoices[] = [];
  const look = async () => {
    now = await Promise.all(pages.map(voices));
    return now;
  };
  try {
    await expect.poll(look, { timeout: 60_000 }).toMatchObject(expected);
  } catch (error) {
    throw new Error(`not seen: ${JSON.stringify(expected)}, but ${JSON.stringify(now)}`, { cause: error });
  }
}

/** Both talk for a minute. What they press is what people press, more often. */
async function talkForAMinute(minute: number, until: number, [ann, ben]: readonly [Page, Page]): Promise<void> {
  const both = [ann, ben];
  for (let i = 0; i < mutesAMinute; i++) {
    await bar(ann).getByRole('button', { name: 'Mute me (T)', exact: true }).press('Enter');
    await seen(both, [{ muted: true }, { other: 'muted' }]);
    await bar(ann).getByRole('button', { name: 'Unmute me (T)', exact: true }).press('Enter');
  }
  if (minute % rejoinEvery === 0) {
    await bar(ben).getByRole('button', { name: 'Leave voice chat' }).press('Enter');
    await seen(both, [{ other: undefined }, { phase: 'off' }]);
    await join(ben);
  }
  await ann.waitForFunction((end) => Date.now() > end, until, { polling: 1000, timeout: 120_000 });
  await seen(both, [
    { link: 'connected', other: 'open' },
    { link: 'connected', other: 'open' },
  ]);
  for (const page of both) await expectVoices(page);
}

/**
 * How much more may be there in the last quarter of a run than in the second, where so much was, and one person has
 * joined so often since.
 */
const allowed: Readonly<Record<keyof PageHolds, (was: number, joins: number) => number>> = {
  // What is compiled as it goes is part of it; a kilobyte a frame would be a megabyte in four minutes.
  heap: (was) => 0.05 * was,
  // Half-used pages, pictures on their way, audio in buffers: 5 % either way from one minute to the next.
  browser: (was) => 0.1 * was,
  // Sentences in the bar and captions.
  nodes: (was) => 0.02 * was,
  // Some wait for one event.
  listeners: () => 5,
  connections: () => 0,
  // Sounds of the game that are in the air; and Chromium keeps the source of a stream until its context is closed: the
  // own voice's, and the other's.
  audioNodes: (_, joins) => 12 + 2 * joins,
  geometries: () => 0,
  // Made when what has them is drawn for the first time: of one frame a minute that may be late.
  textures: () => 2,
};

/** Whether anything has grown from the second quarter of the run to its last. */
function judge(run: readonly Minute[]): void {
  const figures: Record<string, string> = { matches: String(run.at(-1)?.matches) };
  const joins = Math.ceil((0.75 * run.length) / rejoinEvery);
  const compare = (
    name: string,
    of: (minute: Minute) => number,
    more: (was: number, joins: number) => number,
  ): void => {
    const [second, last] = quarters(run, of);
    figures[name] = `${second.toFixed(1)} → ${last.toFixed(1)}`;
    const all = run.map((minute) => of(minute).toFixed(1)).join(', ');
    expect.soft(last - second, `growth of ${name}: ${all}`).toBeLessThanOrEqual(more(second, joins));
  };
  for (const who of ['ann', 'ben'] as const)
    for (const [name, more] of Object.entries(allowed) as [keyof PageHolds, (typeof allowed)['heap']][])
      compare(`${who}, ${name}`, (minute) => minute[who][name], more);
  compare('server, heap', ({ server }) => server.heap, allowed.heap);
  compare('server, all', ({ server }) => server.all, allowed.heap);
  printFigures(`soak of ${minutes} minutes`, figures);
}

declare global {
  interface Window {
    /** Put there by `playMatches` in e2e/rooms/soak.spec.ts. */
    soakMatches?: number;
  }
}

test('the memory of pages and server stays level through matches of two people and a bot @nightly', async ({
  serve,
  talker,
}) => {
  test.setTimeout((minutes + 15) * 60_000);
  const port = await freePort();
  const { origin } = await serve({ NODE_OPTIONS: `--inspect=127.0.0.1:${port}` });
  const light = { seldomDrawn: true, viewport: { width: 160, height: 120 } };
  const ann = await talker(origin, 'Ann', { query: 'bots=on', ...light });
  const ben = await talker(origin, 'Ben', light);
  for (const { page } of [ann, ben]) await join(page);
  await playMatches(ann.page);
  await playMatches(ben.page);
  const bots = async () => (await probe(ann.page)).players.map(({ bot }) => bot).sort();
  await expect.poll(bots, { timeout: 60_000 }).toEqual([false, true]);
  for (const { page } of [ann, ben]) await expectVoices(page);
  const begun = Date.now();
  const server = await inspectNode(port);
  try {
    const read = await reader([ann, ben], server, begun);
    mkdirSync(dirname(file), { recursive: true });
    writeFileSync(file, '');
    const run: Minute[] = [];
    for (let minute = 1; minute <= minutes; minute++) {
      await talkForAMinute(minute, begun + minute * 60_000, [ann.page, ben.page]);
      const seen = await read();
      appendFileSync(file, `${JSON.stringify(seen)}\n`);
      run.push(seen);
    }
    judge(run);
  } finally {
    // A server that is inspected waits for the inspector before it ends.
    server.close();
  }
});
