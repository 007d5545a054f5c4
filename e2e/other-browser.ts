import { type ChildProcess, spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, readdirSync } from 'node:fs';
import puppeteer from 'puppeteer-core';
import { installed } from '../tests/server/installed';
import { freePort } from './free-port';

/** A page in a browser that Playwright does not drive as its distribution builds it. */
export interface OtherBrowser {
  open(address: string): Promise<void>;
  /** Runs a function in the page; what it takes and returns is JSON. */
  evaluate<Result>(script: (...values: string[]) => Result, ...values: string[]): Promise<Result>;
  /** Waits for the element of an XPath, and clicks it as a user does. */
  click(path: string): Promise<void>;
  close(): Promise<void>;
}

/** Returns the XPath of the button whose label starts so. */
export const buttonPath = (label: string): string => `//button[starts-with(normalize-space(), "${label}")]`;

/** The time in which an element must appear [ms]. */
const patienceMs = 60_000;

/** Starts a screen in memory; the browsers draw WebGL 2 on it in software. */
async function startScreen(program: string): Promise<{ readonly display: string; readonly screen: ChildProcess }> {
  const screen = spawn(program, ['-displayfd', '1', '-screen', '0', '1280x800x24'], {
    stdio: ['ignore', 'pipe', 'ignore'],
  });
  const [number] = (await once(screen.stdout, 'data')) as [Buffer];
  return { display: `:${number.toString().trim()}`, screen };
}

async function openFirefox(program: string, display: string): Promise<OtherBrowser> {
  const browser = await puppeteer.launch({
    browser: 'firefox',
    executablePath: program,
    headless: false,
    env: { ...process.env, DISPLAY: display },
    extraPrefsFirefox: { 'webgl.force-enabled': true },
  });
  const [page = await browser.newPage()] = await browser.pages();
  page.setDefaultTimeout(patienceMs);
  await page.setViewport({ width: 960, height: 600 });
  return {
    open: async (address) => void (await page.goto(address)),
    evaluate: (script, ...values) => page.evaluate(script, ...values) as never,
    click: (path) => page.locator(`::-p-xpath(${path})`).click(),
    close: () => browser.close(),
  };
}

/** The key of an element's reference in the WebDriver protocol. */
const elementKey = 'element-6066-11e4-a52e-4f735466cecf';

/** WebKitGTK's small browser stands in a folder of the processor's kind. */
const miniBrowser = () =>
  readdirSync('/usr/lib')
    .map((folder) => `/usr/lib/${folder}/webkit2gtk-4.1/MiniBrowser`)
    .find(existsSync);

/** Opens WebKitGTK's small browser by the WebDriver protocol (https://www.w3.org/TR/webdriver2/). */
async function openWebKit(program: string, display: string): Promise<OtherBrowser> {
  const port = await freePort();
  const driver = spawn(program, [`--port=${port}`], { env: { ...process.env, DISPLAY: display }, stdio: 'ignore' });
  async function ask(method: string, path: string, body?: object): Promise<never> {
    const response = await fetch(`http://127.0.0.1:${port}/session${path}`, { method, body: JSON.stringify(body) });
    const { value } = (await response.json()) as { value: never };
    if (!response.ok) throw new Error(`WebKitWebDriver ${path}: ${JSON.stringify(value)}`);
    return value;
  }
  const capabilities = {
    alwaysMatch: {
      timeouts: { implicit: patienceMs },
      'webkitgtk:browserOptions': { binary: miniBrowser(), args: ['--automation'] },
    },
  };
  const begin = () => ask('POST', '', { capabilities }) as Promise<{ readonly sessionId: string }>;
  let session: Awaited<ReturnType<typeof begin>> | null = null;
  for (const end = Date.now() + 20_000; !session; ) {
    // reason: the driver listens a moment after it starts; its last answer is thrown
    session = await begin().catch((error: unknown) => {
      if (Date.now() > end) throw error;
      return null;
    });
  }
  const { sessionId } = session;
  await ask('POST', `/${sessionId}/window/rect`, { width: 960, height: 700 });
  return {
    open: async (url) => void (await ask('POST', `/${sessionId}/url`, { url })),
    evaluate: (script, ...args) =>
      ask('POST', `/${sessionId}/execute/sync`, { script: `return (${script})(...arguments)`, args }),
    async click(path) {
      const found: Record<string, string> = await ask('POST', `/${sessionId}/element`, { using: 'xpath', value: path });
      await ask('POST', `/${sessionId}/element/${found[elementKey]}/click`, {});
    },
    async close() {
      await ask('DELETE', `/${sessionId}`);
      driver.kill();
    },
  };
}

const screenProgram = installed('Xvfb');
const browsers = {
  Firefox: { program: installed('firefox-esr', 'firefox'), start: openFirefox },
  WebKit: { program: installed('WebKitWebDriver'), start: openWebKit },
} as const;
type BrowserName = keyof typeof browsers;

export const otherBrowsers = Object.keys(browsers) as BrowserName[];

export const isInstalled = (name: BrowserName): boolean => screenProgram !== null && browsers[name].program !== null;

/** Starts a browser on a screen of its own for as long as `use` runs. Throws if it is not installed. */
export async function inBrowser(name: BrowserName, use: (browser: OtherBrowser) => Promise<void>): Promise<void> {
  const { program, start } = browsers[name];
  if (program === null || screenProgram === null) throw new Error(`${name} or Xvfb is not installed`);
  const { display, screen } = await startScreen(screenProgram);
  const browser = await start(program, display);
  try {
    await use(browser);
  } finally {
    await browser.close();
    screen.kill();
  }
}
