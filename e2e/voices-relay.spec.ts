import { createHmac } from 'node:crypto';
import { expect, type Page } from '@playwright/test';
import { cutNetwork } from './cut-network';
import { bar, connected, heard, joinVoices, otherOf, silent, test } from './talkers';
import { startTurn, turnProgram, turnSecret } from './turn-server';

declare global {
  interface Window {
    /** Put there by `keepConnections`: all connections of the page to others. */
    connectionsOfPage?: RTCPeerConnection[];
  }
}

/** In the page: a test can ask its connections. */
function keepConnections(): void {
  const kept: RTCPeerConnection[] = [];
  window.connectionsOfPage = kept;
  window.RTCPeerConnection = class extends RTCPeerConnection {
    constructor(configuration?: RTCConfiguration) {
      super(configuration);
      kept.push(this);
    }
  };
}

/** Kinds of all addresses that a page has found of itself or heard of the other, and the passes of its connections that are open. */
const found = (page: Page) =>
  page.evaluate(async () => {
    const kinds = new Set<string>();
    const passes = new Set<string>();
    for (const pc of window.connectionsOfPage ?? []) {
      if (pc.connectionState === 'closed') continue;
      for (const { username } of pc.getConfiguration().iceServers ?? []) if (username) passes.add(username);
      for (const report of (await pc.getStats()).values())
        if (report.type.endsWith('-candidate')) kinds.add(`${report.type} ${report.candidateType}`);
    }
    return { kinds: [...kinds].sort(), passes: [...passes] };
  });

/** A pass that coturn believes for so long, and no longer. */
function passFor(seconds: number) {
  const username = `${Math.floor(Date.now() / 1000) + seconds}:tests`;
  return { username, credential: createHmac('sha1', turnSecret).update(username).digest('base64') };
}

/** The page's server gives passes to the relay that are good for so long [s], for as long as it answers. */
async function shortPasses(page: Page, url: string, seconds: number) {
  const server = { answers: true, given: 0 };
  await page.route('**/api/voices?**', async (route) => {
    if (!server.answers) return route.fulfill({ status: 503, body: '' });
    server.given += 1;
    const iceServers = [{ urls: [url], ...passFor(seconds) }];
    return route.fulfill({ json: { voices: true, iceServers, goodFor: seconds } });
  });
  return server;
}

async function joinByRelay(page: Page): Promise<void> {
  await bar(page).getByRole('button', { name: 'Talk with the others' }).click();
  await bar(page).getByText('Hide my address: by the relay only').click();
  await bar(page).getByRole('button', { name: 'Join, muted' }).click();
}

// A program of the distribution, not ours to install: apt-get install coturn
test.describe(`voices by the relay only${turnProgram === null ? ' (coturn is not installed)' : ''}`, () => {
  // biome-ignore lint/suspicious/noSkippedTests: a program of the distribution is missing, which the name of the suite says
  test.skip(turnProgram === null, 'coturn is not installed: apt-get install coturn');

  test('two people hear each other, and no page learns an address but the relay’s; a pass is renewed in time @nightly', async ({
    serve,
    talker,
  }) => {
    test.setTimeout(600_000);
    const turn = await startTurn();
    try {
      const { origin } = await serve({ THREEPOINT_TURN: turn.url, THREEPOINT_TURN_SECRET: turnSecret });
      const join = async (name: string): Promise<Page> => {
        const { page } = await talker(origin, name, { inPage: keepConnections });
        await joinByRelay(page);
        return page;
      };
      const [ann, ben] = [await join('Ann'), await join('Ben')];
      await connected(ann);
      await connected(ben);
      for (const page of [ann, ben]) await bar(page).getByRole('button', { name: 'Unmute me' }).click();
      await heard(ann);
      await heard(ben);
      for (const page of [ann, ben])
        expect((await found(page)).kinds).toEqual(['local-candidate relay', 'remote-candidate relay']);

      // Once more under passes of forty seconds: each page asks for another one after thirty.
      await bar(ann).getByRole('button', { name: 'Leave the voices' }).click();
      await silent(ben);
      const server = await shortPasses(ann, turn.url, 40);
      await joinVoices(ann);
      await bar(ann).getByRole('button', { name: 'Unmute me' }).click();
      await heard(ben);
      const first = (await found(ann)).passes;
      await expect.poll(async () => (await found(ann)).passes, { timeout: 120_000 }).not.toEqual(first);
      expect(server.given).toBeGreaterThanOrEqual(2);
      await connected(ann);
      await heard(ben);
    } finally {
      await turn.close();
    }
  });

  test('a call goes on under a pass that has expired; lost, it comes back when the server gives another @nightly', async ({
    serve,
    talker,
  }) => {
    test.setTimeout(900_000);
    // As short as coturn lets an allocation last: pages refresh theirs every half a minute instead of every nine.
    const turn = await startTurn('--max-allocate-lifetime=60');
    const seconds = 40;
    try {
      const { origin } = await serve({ THREEPOINT_TURN: turn.url, THREEPOINT_TURN_SECRET: turnSecret });
      const light = { inPage: keepConnections, seldomDrawn: true };
      const [ann, ben] = [await talker(origin, 'Ann', light), await talker(origin, 'Ben', light)];
      const server = await shortPasses(ann.page, turn.url, seconds);
      for (const { page } of [ann, ben]) await joinByRelay(page);
      for (const { page } of [ann, ben]) await bar(page).getByRole('button', { name: 'Unmute me' }).click();
      await heard(ben.page);
      server.answers = false;
      const expired = Date.now() + 1000 * (seconds + 5);
      await ann.page.waitForFunction((at) => Date.now() > at, expired, { polling: 1000, timeout: 120_000 });
      const passes = (await found(ann.page)).passes;
      for (const pass of passes) expect(Number(pass.split(':')[0])).toBeLessThan(Date.now() / 1000);
      // Refreshes of Ann's allocations under such a pass, in coturn's own words.
      const refreshed = () =>
        turn.said
          .split('\n')
          .filter((line) => line.includes(' refreshed') && passes.some((pass) => line.includes(`<${pass}>`)));
      const before = refreshed().length;
      await expect.poll(() => refreshed().length, { timeout: 180_000 }).toBeGreaterThan(before + 3);
      await heard(ben.page);
      await heard(ann.page);
      console.log(`voices: ${refreshed().length - before} refreshes under a pass that had expired`);

      // A connection that is lost needs new allocations, and gets none.
      const mend = cutNetwork(ann.pid);
      try {
        await expect.poll(async () => (await otherOf(ben.page))?.link, { timeout: 120_000 }).toBe('lost');
      } finally {
        mend();
      }
      await silent(ben.page);
      server.answers = true;
      await heard(ben.page);
      await heard(ann.page);
    } finally {
      await turn.close();
    }
  });
});
