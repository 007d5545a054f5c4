import { spawn, spawnSync } from 'node:child_process';
import { once } from 'node:events';
import { copyFileSync, mkdtempSync, renameSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { test as base } from '@playwright/test';
import { unzipSync } from 'fflate';
import { collectErrors, expect } from '../page-fixture';
import { experimenter, experimenterToken, shortStudy } from '../study-server';

const root = fileURLToPath(new URL('../..', import.meta.url));

/** Runs a script of the project with a plug-in, whose path is relative to `directory`; returns its output. */
function script(directory: string, plugins: string, ...args: readonly string[]): string {
  const env = { ...process.env, INIT_CWD: directory, THREEPOINT_STUDY_PLUGINS: plugins };
  const { status, stdout, stderr } = spawnSync(process.execPath, args, {
    cwd: root,
    env,
    encoding: 'utf8',
  });
  expect(status, `${stdout}${stderr}`).toBe(0);
  return stdout;
}

/** Runs an npm script of a study with the plug-in. */
const program = (directory: string, ...args: readonly string[]) =>
  script(directory, 'agreement.mjs', 'scripts/tool.mjs', ...args);

/** The example of docs/study.md in a folder of its own, beside a page and a server that are built with it. */
const test = base.extend<{ directory: string; origin: string }>({
  // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
  directory: async ({}, use) => {
    const directory = mkdtempSync(join(tmpdir(), 'threepoint-plugins-'));
    copyFileSync(join(root, 'tests/study/plugins/agreement.mjs'), join(directory, 'agreement.mjs'));
    await use(directory);
    rmSync(directory, { recursive: true, force: true });
  },
  origin: async ({ directory }, use) => {
    script(directory, 'agreement.mjs', 'scripts/build.mjs', '--out', join(directory, 'dist'));
    script(directory, '', 'scripts/build-server.mjs', '--out', join(directory, 'server'));
    renameSync(join(directory, 'server/package.json'), join(directory, 'package.json'));
    symlinkSync(join(root, 'node_modules'), join(directory, 'node_modules'));
    const server = spawn(process.execPath, ['server/main.mjs', '--port', '0'], {
      cwd: directory,
      env: { PATH: process.env.PATH, EXPERIMENTER_TOKEN: experimenterToken, THREEPOINT_STUDY_PLUGINS: 'agreement.mjs' },
      stdio: ['ignore', 'pipe', 'inherit'],
    });
    const [welcome] = await once(server.stdout, 'data');
    await use(/http:\/\/localhost:\d+/.exec(String(welcome))?.[0] ?? `no address: ${welcome}`);
    server.kill();
    await once(server, 'exit');
  },
});

/** A study with a questionnaire of the plug-in's kind. */
function planWithAgreement() {
  const plan = shortStudy('agreement');
  const answer = { kind: 'agreement', yes: 'I agree', no: 'I disagree' };
  const questions = [{ id: 'body', text: 'Was it your body?' }];
  return {
    ...plan,
    tasks: plan.tasks.map((task) => ({ ...task, questionnaire: 'presence' })),
    questionnaires: [{ id: 'presence', title: 'Presence', answer, questions }],
    planned: [],
    askToStop: undefined,
  };
}

test('a kind of question from outside works in command line, server, export and page @full', async ({
  page,
  directory,
  origin,
}) => {
  test.setTimeout(300_000);
  const plan = JSON.stringify(planWithAgreement());
  const file = join(directory, 'plan.json');
  writeFileSync(file, plan);
  expect(program(directory, 'study:check', file)).toContain('the plan is valid');
  program(directory, 'study:simulate', file, '--out', join(directory, 'simulated'), '--participants', '2');
  const zip = join(directory, 'simulated/SIMULATED-agreement-simulated.zip');
  expect(program(directory, 'study:verify', zip)).toContain('sound');

  const { ask } = experimenter(origin);
  expect((await ask('', 'POST', { plan: JSON.parse(plan), simulated: false })).status).toBe(201);
  const exported = await ask('/agreement/export');
  expect(exported.status).toBe(200);
  const questions = Object.entries(unzipSync(new Uint8Array(await exported.arrayBuffer()))).find(([name]) =>
    name.endsWith('questions.csv'),
  );
  expect(new TextDecoder().decode(questions?.[1])).toContain('1: I agree; 0: I disagree');

  const { errors } = collectErrors(page, `${origin}/`);
  await page.route(
    ({ pathname }) => pathname === '/studies/agreement.json',
    (route) => route.fulfill({ body: plan }),
  );
  await page.goto(`${origin}/preview?plan=/studies/agreement.json`);
  await page
    .getByRole('button', { name: /^body: / })
    .first()
    .click();
  await expect(page.locator('canvas')).toHaveAccessibleName(/Was it your body/);
  await page.getByRole('button', { name: 'At the desk' }).click();
  const agree = page.getByRole('button', { name: 'I agree', exact: true });
  await agree.click();
  await expect(agree).toHaveAttribute('aria-pressed', 'true');
  for (const path of ['', 'experimenter', 'results']) await page.goto(`${origin}/${path}`);
  expect(errors).toEqual([]);
});

test('a plug-in that cannot be loaded stops the server with its path @full', async ({ directory }) => {
  writeFileSync(join(directory, 'broken.mjs'), 'export default 5;');
  const { status, stderr } = spawnSync(
    process.execPath,
    ['--import', 'tsx', 'server/main.ts', '--port', '0', '--studies', join(directory, 'studies')],
    {
      cwd: root,
      env: { ...process.env, THREEPOINT_STUDY_PLUGINS: join(directory, 'broken.mjs') },
      encoding: 'utf8',
      timeout: 60_000,
    },
  );
  expect(status).toBe(1);
  expect(stderr).toContain(`THREEPOINT_STUDY_PLUGINS: ${join(directory, 'broken.mjs')} could not be loaded.`);
  expect(stderr).toContain('must be a function');
});
