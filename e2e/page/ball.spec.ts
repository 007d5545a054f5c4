import { spawn } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import type { Browser } from '@playwright/test';
import type { BallActivityProbe } from '../../src/page/ball/ball-activity';
import type { BallProbe } from '../../src/page/ball/match/ball-probe';
import { drawSeldom } from '../draw-seldom';
import { driveTime, goOn, holdAt } from '../driven-time';
import { emulatedHeadset } from '../emulated-headset';
import { freePort } from '../free-port';
import { enterVr, expect, gameOn, joinedRoom, keepPicture, open, pressReady, probe, test } from '../page-fixture';

// What is played does not depend on how many pixels show it.
test.use({ viewport: { width: 480, height: 300 } });

type Page = Parameters<typeof open>[0];

/** Waits until the match is as asked; fails with how it is. */
async function until(page: Page, what: (game: BallProbe) => boolean, timeout = 60_000): Promise<BallProbe> {
  let last: BallProbe | null = null;
  await expect(async () => {
    last = await gameOn(page, 'ball');
    expect(last !== null && what(last), `the match: ${JSON.stringify(last)}`).toBe(true);
  }).toPass({ timeout, intervals: [100, 250, 500] });
  return last as unknown as BallProbe;
}

test('one person with two bots plays a short match to its end, and again', async ({ page }) => {
  await open(page, 'play=ball&panel=off&quality=low&estimator=ik&seed=5&balls=2&seconds=90');
  await until(page, ({ phase }) => phase === 'running');
  const { players } = await probe(page);
  expect(players.map(({ bot }) => bot)).toEqual([true, true]);
  await keepPicture(page, 'ball-running');
  // A player's buttons stand beside the name.
  const hide = await page.getByRole('button', { name: /Hide . · Kim/ }).boundingBox();
  const name = await page
    .getByRole('list', { name: 'Other players' })
    .getByText('Kim (bot)', { exact: true })
    .boundingBox();
  if (!hide || !name) throw new Error('the list of the other players is not to be seen');
  expect(hide.x).toBeGreaterThanOrEqual(name.x + name.width);
  expect(Math.abs(hide.y + hide.height / 2 - name.y - name.height / 2)).toBeLessThan(4);
  await driveTime(page);
  const over = await until(page, ({ phase }) => phase === 'over');
  expect(over.end).toBe('balls');
  expect(over.balls.basket).toBe(over.score);
  expect(over.score).toBeGreaterThanOrEqual(1);
  await keepPicture(page, 'ball-result');
  const again = await until(page, ({ phase }) => phase === 'running');
  expect(again.score).toBeLessThanOrEqual(over.score);
});

test('in the emulated headset the built-in player throws with its tracked hands @full', async ({ page }) => {
  await open(page, 'emulate&play=ball&panel=off&quality=low&estimator=ik&seed=5&balls=2&seconds=40');
  await emulatedHeadset(page);
  await enterVr(page);
  await until(page, ({ phase, held }) => phase === 'running' && (held.left !== null || held.right !== null));
  await keepPicture(page, 'ball-headset');
  const over = await until(page, ({ phase }) => phase === 'over');
  expect(over.balls.hand).toBe(0);
});

test('a person who plays by hand is asked before a match begins, and can wait @full', async ({ page }) => {
  await open(page, 'play=ball&panel=off&quality=low&estimator=ik&actor=off&emulate');
  await page.getByRole('button', { name: 'Ready', exact: true }).click();
  await driveTime(page);
  await until(page, ({ phase }) => phase === 'running');
});

test('without a headset a mouse takes a ball, aims and throws it @full', async ({ page }) => {
  await open(page, 'play=ball&panel=off&quality=low&estimator=ik&bots=on&seconds=600');
  await driveTime(page);
  // The built-in player has begun the match: a person who wants to play takes over.
  await until(page, ({ phase }) => phase === 'running');
  await page.getByRole('button', { name: 'Play with the mouse' }).click();
  await expect(page.getByText('Point at the basket and hold the button')).toBeVisible();
  await until(page, ({ held }) => held.left !== null || held.right !== null);
  await page.mouse.move(250, 130);
  await page.mouse.down();
  await until(page, ({ aim }) => (aim ?? 0) > 5.5);
  await keepPicture(page, 'ball-mouse');
  // Frame by frame: the next ball is soon in the hand.
  const gone = holdAt<BallActivityProbe>(page, { phase: 'running', aim: null, held: { left: null, right: null } });
  await Promise.all([gone, page.mouse.up()]);
  await goOn(page);
  await page.getByRole('button', { name: 'Let the computer play' }).click();
  await until(page, ({ ballsLeft }) => ballsLeft < 18);
});

test('a spectator sees three bots and follows one of them @full', async ({ page }) => {
  await open(page, 'play=ball&spectate&bots=on&panel=off&quality=low&estimator=ik&seconds=60');
  await driveTime(page);
  await until(page, ({ phase }) => phase === 'running');
  expect((await gameOn(page, 'ball'))?.seat).toBe(null);
  await expect.poll(async () => (await probe(page)).players.length).toBe(3);
  await page.getByRole('group', { name: 'Camera' }).getByRole('button', { name: 'Kim' }).click();
  await expect(page.getByRole('button', { name: 'Kim', pressed: true })).toBeVisible();
});

/** The server as `npm start` runs it, page and relay on one port; it can be killed and started again. */
async function startServer(seconds: number, port: number): Promise<{ kill(): Promise<void> }> {
  const root = fileURLToPath(new URL('../..', import.meta.url));
  const server = spawn(process.execPath, ['--import', 'tsx', 'server/main.ts', '--port', String(port)], {
    cwd: root,
    env: { ...process.env, THREEPOINT_BALL_SECONDS: String(seconds) },
    stdio: ['ignore', 'inherit', 'inherit'],
  });
  await expect
    .poll(
      () =>
        fetch(`http://127.0.0.1:${port}/healthz`).then(
          ({ ok }) => ok,
          () => false,
        ),
      { timeout: 30_000 },
    )
    .toBe(true);
  return {
    async kill() {
      if (server.exitCode !== null || server.signalCode !== null) return;
      const ended = new Promise((resolve) => server.once('exit', resolve));
      server.kill('SIGKILL');
      await ended;
    },
  };
}

/** Another person's browser in this room, drawn as small as a picture can be; resolves once it has joined. */
async function join(browser: Browser, port: number, room: string, query: string): Promise<Page> {
  // A browser each: pages of one browser would all be drawn by one process, one after the other.
  const own = await browser.browserType().launch(test.info().project.use.launchOptions);
  const page = await own.newPage({ viewport: { width: 240, height: 150 } });
  await drawSeldom(page);
  await page.goto(
    `http://localhost:${port}/?play=ball&room=${room}&panel=off&quality=low&estimator=ik&overlay=off&${query}`,
  );
  await joinedRoom(page);
  return page;
}

/**
 * Resolves once this page has seen a player's elbow go this far in all [m], floor frame; rejects with the way it has
 * seen.
 */
function elbowTravels(page: Page, seat: number, least = 0.2): Promise<unknown> {
  return page.waitForFunction(
    ([seat, least]) => {
      const kept = window as unknown as { elbows?: Record<number, { at: readonly number[]; travelled: number }> };
      kept.elbows ??= {};
      const at = window.threepoint?.probe().players.find((player) => player.seat === seat)?.joints.rightLowerArm;
      if (!at) return false;
      const before = kept.elbows[seat] ?? { at, travelled: 0 };
      const step = Math.hypot(...at.map((value, axis) => value - (before.at[axis] ?? value)));
      kept.elbows[seat] = { at, travelled: before.travelled + step };
      return before.travelled + step > least;
    },
    [seat, least] as const,
    { timeout: 180_000 },
  );
}

/** How the match ended, as this page saw it at that moment. */
async function resultOn(page: Page, timeout: number): Promise<Pick<BallProbe, 'score' | 'end' | 'balls'>> {
  const ended = await page.waitForFunction(
    () => {
      const { game } = window.threepoint?.probe() ?? {};
      return game?.name === 'ball' && game.phase === 'over' && { score: game.score, end: game.end, balls: game.balls };
    },
    undefined,
    { timeout },
  );
  return (await ended.jsonValue()) as Pick<BallProbe, 'score' | 'end' | 'balls'>;
}

const leave = (page: Page): Promise<void> | undefined => page.context().browser()?.close();

test('three browsers play a whole match over the relay and agree, one watches, one comes late @nightly', async ({
  browser,
}) => {
  test.setTimeout(600_000);
  const seconds = 90;
  const port = await freePort();
  const server = await startServer(seconds, port);
  const all: Page[] = [];
  try {
    const come = async (query: string) => {
      const page = await join(browser, port, 'three', query);
      all.push(page);
      return page;
    };
    const names = ['ann', 'ben', 'cal'];
    const people: Page[] = [];
    for (const name of names) people.push(await come(`name=${name}`));
    const [ann, ben, cal] = people as [Page, Page, Page];
    await come('spectate&name=dora');
    // The sender solves, so an elbow moves on the receiver's picture as it does on the sender's own.
    for (const person of people) await pressReady(person);
    await Promise.all([elbowTravels(cal, 0), elbowTravels(ann, 1), elbowTravels(ben, 2, 0.05)]);
    // At one frame a second the first match may end without a catch: then a later match scores.
    const scored = await until(ann, ({ score, phase }) => score > 0 && phase === 'running', 3 * (seconds + 20) * 1000);
    expect(scored.score).toBeGreaterThan(0);
    const late = await come('spectate&name=eve');
    const seen = await until(late, ({ people: there }) => there.every(Boolean));
    expect(seen.people.map((person) => person?.name)).toEqual(names);
    await expect
      .poll(async () => (await probe(late)).players.map(({ seat }) => seat).sort(), { timeout: 60_000 })
      .toEqual([0, 1, 2]);
    await Promise.all([0, 1].map((seat) => elbowTravels(late, seat)));
    await keepPicture(late, 'ball-watched');
    const results = await Promise.all(all.map((page) => resultOn(page, (seconds + 60) * 1000)));
    console.log(`${results.length} browsers saw: ${results.map(({ score, end }) => `${score} (${end})`).join(', ')}`);
    for (const result of results) expect(result).toEqual(results[0]);
    expect(results[0]?.balls.basket).toBe(results[0]?.score);
  } finally {
    await Promise.all(all.map(leave));
    await server.kill();
  }
});

test('a relay restarted in the middle of a match brings all back and voids the round @realtime', async ({
  browser,
}) => {
  test.setTimeout(300_000);
  const port = await freePort();
  let running = await startServer(60, port);
  try {
    const page = await join(browser, port, 'again', 'name=ann&bots=on');
    await until(page, ({ people }) => people.every(Boolean), 60_000);
    await expect(page.getByText('Waiting for you: press Ready.')).toBeVisible();
    await pressReady(page);
    await until(page, ({ phase, ballsLeft }) => phase === 'running' && ballsLeft < 20, 90_000);
    await running.kill();
    await expect(page.locator('#banner')).toBeVisible();
    await keepPicture(page, 'ball-banner');
    running = await startServer(60, port);
    const back = Date.now();
    await until(page, ({ connection, voided }) => connection === 'joined' && voided === 1, 30_000);
    console.log(`back in the room ${((Date.now() - back) / 1000).toFixed(1)} s after the restart`);
    await pressReady(page);
    await until(page, ({ phase, people }) => phase === 'running' && people.every(Boolean), 60_000);
    await leave(page);
  } finally {
    await running.kill();
  }
});
