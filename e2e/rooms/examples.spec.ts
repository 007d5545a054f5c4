import { type ChildProcess, spawn } from 'node:child_process';
import { once } from 'node:events';
import { readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { type Browser, type BrowserContext, expect, type Page, test } from '@playwright/test';
import { buildExample, pack, roomExampleNames } from '../../scripts/build-examples.mjs';
import { screenshot } from '../draw-seldom';
import type { EmulatedHeadset, Placement, Point } from '../emulated-headset';
import { emulateHeadset, enterExample, faultsOf, ownJoint } from '../example-page';
import { freePort } from '../free-port';
import { wristByGrip, wristName } from '../hands-on-controllers';
import { distance } from '../page-fixture';
import { serveStatic } from '../static-server';

/** The parts of three.js objects by which the others' bodies are measured. */
interface Placed {
  readonly matrixWorld: { readonly elements: number[] };
}

interface Body {
  readonly visible: boolean;
  getObjectByName(name: string): Placed | undefined;
}

declare global {
  interface Window {
    /** The object with a body for each other person, which every example leaves on the window. */
    others?: Placed & { readonly children: readonly Body[] };
    /** The room, which the examples with `joinRoom` leave on the window. */
    room?: {
      readonly seat: number | null;
      readonly others: { readonly people: readonly { readonly name: string }[] };
      leave(): void;
    };
  }
}

const scripts: Readonly<Record<string, string>> = { 'rooms-react-three-fiber': 'main.jsx' };
/** The programs that serve an example; the first is the one that its reader starts. */
const servers: Readonly<Record<string, readonly string[]>> = {
  'rooms-three': ['server.js', 'server-node.js', 'server-fastify.js'],
  'webrtc-three': [],
};
const serversOf = (name: string) => servers[name] ?? ['server.js'];
const hasSeats = (name: string) => name.startsWith('rooms-');

const placements: Readonly<Record<string, Placement>> = {
  Ann: {
    head: { position: [0.2, 1.62, 0.1] },
    left: { position: [-0.05, 1.45, -0.3] },
    right: { position: [0.5, 1.5, -0.35] },
  },
  Ben: {
    head: { position: [-0.4, 1.7, -0.3] },
    left: { position: [-0.7, 1.2, -0.6] },
    right: { position: [-0.2, 1.35, -0.7] },
  },
};

/** A person in a browser of their own, in an example's page. */
interface Person {
  readonly name: string;
  readonly page: Page;
  readonly faults: readonly string[];
  readonly headset: EmulatedHeadset;
}

async function arrive(context: BrowserContext, name: string, address: string): Promise<Person> {
  const page = await context.newPage();
  const faults = faultsOf(page);
  await emulateHeadset(page);
  await page.goto(`${address}?name=${name}`);
  return { name, page, faults, headset: await enterExample(page, placements[name]!) };
}

/** Returns the bodies of other people in the page: how many there are, and how many of them are shown. */
const bodiesIn = ({ page }: Person) =>
  page.evaluate(() => {
    const children = window.others?.children ?? [];
    return { loaded: children.length, shown: children.filter(({ visible }) => visible).length };
  });

/** Returns a point of a page's scene in the frame that the people share, which is that of the others' bodies. */
const inSharedFrame = ({ page }: Person, point: Point): Promise<Point> =>
  page.evaluate(([x, y, z]) => {
    const shared = new DOMMatrix(window.others!.matrixWorld.elements).inverse().transformPoint({ x, y, z });
    return [shared.x, shared.y, shared.z] as const;
  }, point);

/** Returns where a joint of the only shown body of another person is drawn in the scene [m]; null: there is none. */
const drawnJoint = ({ page }: Person, name: string): Promise<Point | null> =>
  page.evaluate((name) => {
    const shown = window.others?.children.filter(({ visible }) => visible) ?? [];
    const elements = shown.length === 1 ? shown[0]?.getObjectByName(name)?.matrixWorld.elements : undefined;
    return elements ? ([elements[12]!, elements[13]!, elements[14]!] as const) : null;
  }, name);

/** Waits until a joint of the other is drawn within 1 cm of this position in the shared frame. */
async function expectDrawn(viewer: Person, joint: string, wanted: () => Promise<Point>): Promise<number> {
  let millimetres = Number.NaN;
  await expect
    .poll(
      async () => {
        const drawn = await drawnJoint(viewer, joint);
        const at = drawn && (await inSharedFrame(viewer, drawn));
        millimetres = at ? 1000 * distance(at, await wanted()) : Number.POSITIVE_INFINITY;
        return millimetres;
      },
      { message: `the other's ${joint} in ${viewer.name}'s page [mm]`, intervals: [100] },
    )
    .toBeLessThan(10);
  return millimetres;
}

/** Checks that a page draws the other where they are: hands by the controllers, elbows by the other's own page. */
async function expectSees(viewer: Person, other: Person): Promise<void> {
  const distances: string[] = [];
  for (const side of ['left', 'right'] as const) {
    const ofHand = async () => inSharedFrame(other, await wristByGrip(other.headset, side));
    const ofElbow = async () => inSharedFrame(other, await ownJoint(other.page, `${side}LowerArm`));
    const hand = await expectDrawn(viewer, wristName[side], ofHand);
    const elbow = await expectDrawn(viewer, `${side}LowerArm`, ofElbow);
    distances.push(`${side} hand ${hand.toFixed(1)} mm, elbow ${elbow.toFixed(1)} mm`);
  }
  console.log(`${other.name} in ${viewer.name}'s page: ${distances.join('; ')}`);
  expect(await bodiesIn(viewer)).toEqual({ loaded: 1, shown: 1 });
}

/** Starts the example's own server; resolves to its address once it answers. */
async function serveExample(folder: string, program: string) {
  const port = await freePort();
  const address = `http://127.0.0.1:${port}/`;
  const server: ChildProcess = spawn(process.execPath, [program], {
    cwd: folder,
    env: { ...process.env, PORT: String(port), NODE_OPTIONS: '' },
    stdio: ['ignore', 'ignore', 'inherit'],
  });
  const ended = once(server, 'exit');
  await expect
    .poll(
      () =>
        fetch(address).then(
          ({ status }) => status,
          () => 0,
        ),
      { message: `${program} serves its page` },
    )
    .toBe(200);
  return {
    address,
    async close() {
      server.kill();
      await ended;
    },
  };
}

/** Carries the texts of a connection over WebRTC from page to page, as two people do. */
async function exchangeTexts(one: Page, other: Page): Promise<void> {
  const carry = async (from: Page, to: Page, type: string) => {
    await expect(from.locator('#mine')).toHaveValue(new RegExp(`"type":"${type}"`));
    await to.locator('#theirs').fill(await from.locator('#mine').inputValue());
  };
  await carry(one, other, 'offer');
  await carry(other, one, 'answer');
}

/** Ann and Ben in an example, each in a browser of their own. */
class Meeting {
  private constructor(
    private readonly server: { readonly address: string; close(): Promise<void> },
    private readonly contexts: readonly [BrowserContext, BrowserContext],
    /** Whether the people exchange the texts of their connection themselves. */
    private readonly byTexts: boolean,
    readonly ann: Person,
    private ben: Person,
  ) {}

  static async start(browsers: readonly [Browser, Browser], folder: string, program?: string): Promise<Meeting> {
    const server = await (program ? serveExample(folder, program) : serveStatic(join(folder, 'dist')));
    const viewport = { width: 320, height: 180 };
    const contexts = [await browsers[0].newContext({ viewport }), await browsers[1].newContext({ viewport })] as const;
    const [ann, ben] = await Promise.all([
      arrive(contexts[0], 'Ann', server.address),
      arrive(contexts[1], 'Ben', server.address),
    ]);
    const meeting = new Meeting(server, contexts, !program, ann, ben);
    if (meeting.byTexts) await exchangeTexts(ann.page, ben.page);
    return meeting;
  }

  async seeEachOther(): Promise<void> {
    await expectSees(this.ann, this.ben);
    await expectSees(this.ben, this.ann);
  }

  async reloadKeepsSeat(): Promise<void> {
    const seat = () => this.ben.page.evaluate(() => window.room?.seat);
    const before = await seat();
    expect(before).toEqual(expect.any(Number));
    await this.ben.page.reload();
    this.ben = { ...this.ben, headset: await enterExample(this.ben.page, placements.Ben!) };
    await expect.poll(seat, { message: 'Ben has a seat again' }).toEqual(expect.any(Number));
    expect(await seat()).toBe(before);
    await this.seeEachOther();
    expect(await this.ann.page.evaluate(() => window.room?.others.people.map(({ name }) => name))).toEqual(['Ben']);
  }

  /** `kept`: how many hidden bodies a page keeps for the next person. */
  async leaveAndReturn(kept: number): Promise<void> {
    // A room keeps the place of a page that is gone, unless it says goodbye.
    await this.ben.page.evaluate(() => window.room?.leave());
    await this.ben.page.close();
    await expect.poll(() => bodiesIn(this.ann), { message: 'Ben is gone' }).toEqual({ loaded: kept, shown: 0 });
    expect(this.ben.faults).toEqual([]);
    this.ben = await arrive(this.contexts[1], 'Ben', this.server.address);
    if (this.byTexts) await exchangeTexts(this.ann.page, this.ben.page);
    await this.seeEachOther();
  }

  async end(): Promise<void> {
    expect([...this.ann.faults, ...this.ben.faults]).toEqual([]);
    await Promise.all(this.contexts.map((context) => context.close()));
    await this.server.close();
  }
}

test.describe('examples of other people @realtime', () => {
  let folder = '';
  let secondBrowser: Browser;
  test.beforeAll(async ({ browser, playwright, launchOptions }) => {
    test.setTimeout(180_000);
    secondBrowser = await playwright[browser.browserType().name() as 'chromium'].launch(launchOptions);
    folder = await pack();
  });
  test.afterAll(async () => {
    await secondBrowser.close();
    if (folder) rmSync(folder, { recursive: true });
  });

  test('are short @realtime', () => {
    for (const name of roomExampleNames) {
      const lines = [scripts[name] ?? 'main.js', ...serversOf(name).slice(0, 1)].flatMap((file) =>
        readFileSync(new URL(`../../examples/${name}/${file}`, import.meta.url), 'utf8')
          .split('\n')
          .filter((line) => line.trim() !== ''),
      );
      expect(lines.length, name).toBeLessThanOrEqual(60);
    }
  });

  for (const name of roomExampleNames) {
    test(`${name}: two people see each other where they are @realtime`, async ({ browser }) => {
      test.setTimeout(240_000);
      const own = await buildExample(name, folder);
      const [program, ...otherPrograms] = serversOf(name);
      const meeting = await Meeting.start([browser, secondBrowser], own, program);
      await meeting.seeEachOther();
      await screenshot(meeting.ann.page, `artifacts/examples/${name}.png`);
      if (hasSeats(name)) await meeting.reloadKeepsSeat();
      await meeting.leaveAndReturn(hasSeats(name) ? 1 : 0);
      await meeting.end();
      for (const other of otherPrograms) {
        const again = await Meeting.start([browser, secondBrowser], own, other);
        await again.seeEachOther();
        await again.end();
      }
    });
  }
});
