import { createHmac } from 'node:crypto';
import { expect, type Page } from '@playwright/test';
import { bar, connected, expectSilence, expectVoices, joinVoices, test } from '../talkers';
import { startTurn, turnProgram, turnSecret } from '../turn-server';

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

/** Returns the kinds of all local and remote ICE candidates of a page, and the credentials of its open connections. */
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
    return route.fulfill({ json: { voices: true, iceServers, ttlSeconds: seconds } });
  });
  return server;
}

// A program of the distribution, not ours to install: apt-get install coturn
test.describe(`voices by the relay only${turnProgram === null ? ' (coturn is not installed)' : ''}`, () => {
  // biome-ignore lint/suspicious/noSkippedTests: reason: a program that the suite's name mentions is missing
  test.skip(turnProgram === null, 'coturn is not installed: apt-get install coturn');

  test('two people hear each other through renewed passes, and pages learn no address but the relay’s @nightly', async ({
    serve,
    talker,
  }) => {
    test.setTimeout(600_000);
    const turn = await startTurn();
    try {
      const { origin } = await serve({ THREEPOINT_TURN: turn.url, THREEPOINT_TURN_SECRET: turnSecret });
      const join = async (name: string): Promise<Page> => {
        const { page } = await talker(origin, name, { inPage: keepConnections });
        await bar(page).getByRole('button', { name: 'Talk with the others' }).click();
        await bar(page).getByText('Hide my address (relay only)').click();
        await bar(page).getByRole('button', { name: 'Join, muted' }).click();
        return page;
      };
      const [ann, ben] = [await join('Ann'), await join('Ben')];
      await connected(ann);
      await connected(ben);
      for (const page of [ann, ben]) await bar(page).getByRole('button', { name: 'Unmute me' }).click();
      await expectVoices(ann);
      await expectVoices(ben);
      for (const page of [ann, ben])
        expect((await found(page)).kinds).toEqual(['local-candidate relay', 'remote-candidate relay']);

      // Once more under passes of forty seconds: each page asks for another one after thirty.
      await bar(ann).getByRole('button', { name: 'Leave voice chat' }).click();
      await expectSilence(ben);
      const server = await shortPasses(ann, turn.url, 40);
      await joinVoices(ann);
      await bar(ann).getByRole('button', { name: 'Unmute me' }).click();
      await expectVoices(ben);
      const first = (await found(ann)).passes;
      await expect.poll(async () => (await found(ann)).passes, { timeout: 120_000 }).not.toEqual(first);
      expect(server.given).toBeGreaterThanOrEqual(2);
      await connected(ann);
      await expectVoices(ben);
      // The call outlives its pass where the server gives no other.
      server.answers = false;
      await ann.waitForFunction((until) => Date.now() > until, Date.now() + 60_000, {
        polling: 1000,
        timeout: 120_000,
      });
      await connected(ann);
      await expectVoices(ben);
      await expectVoices(ann);
      expect((await found(ann)).kinds).toEqual(['local-candidate relay', 'remote-candidate relay']);
    } finally {
      await turn.close();
    }
  });
});
