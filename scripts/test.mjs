// npm test: installs what is missing, runs every stage whether or not one before it failed, and ends with one line that
// counts the tests. Names of stages as arguments run those alone.
import { mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { buildWhenStale } from './build.mjs';
import { ensureChromium } from './chromium.mjs';
import { ensureInstalled } from './installation.mjs';
import { pythonEnvironment } from './python-environment.mjs';
import { main, root, run, SetupError } from './run-command.mjs';
import { countLine, readResults } from './test-results.mjs';

const reports = join(root, 'artifacts/test-reports');
const node = (script, ...args) => [process.execPath, join('node_modules', script), ...args];

const pytest = async ({ extras, marker, report }) => {
  const python = await pythonEnvironment({ extras });
  return [[python, '-m', 'pytest', 'training', '-m', marker, '-p', 'no:cacheprovider', `--junitxml=${report}`]];
};

/** Each stage: the commands it consists of, and for runners of tests the report they leave. */
const stages = {
  types: {
    commands: () => [
      node('typescript/bin/tsc', '--noEmit'),
      node('typescript/bin/tsc', '--noEmit', '-p', 'tsconfig.core.json'),
    ],
  },
  lint: { commands: () => [node('@biomejs/biome/bin/biome', 'check', '.')] },
  dependencies: {
    commands: () => [
      node(
        'dependency-cruiser/bin/dependency-cruise.mjs',
        '--config',
        '.dependency-cruiser.mjs',
        'src',
        'server',
        'tests',
        'e2e',
        'bench',
      ),
    ],
  },
  unit: {
    runner: 'vitest',
    commands: (report) => [
      node('vitest/vitest.mjs', 'run', '--reporter=default', '--reporter=json', `--outputFile.json=${report}`),
    ],
  },
  python: { runner: 'pytest', commands: (report) => pytest({ extras: [], marker: 'not training', report }) },
  e2e: {
    runner: 'playwright',
    limitSeconds: 1200,
    commands: async (report) => {
      process.env.CHROMIUM_PATH = await ensureChromium();
      process.env.PLAYWRIGHT_JSON_OUTPUT_NAME = report;
      await buildWhenStale();
      return [node('@playwright/test/cli.js', 'test', '--reporter=list,json')];
    },
  },
  training: {
    runner: 'pytest',
    limitSeconds: 1200,
    byName: true,
    commands: (report) => pytest({ extras: ['train'], marker: 'training', report }),
  },
  nightly: {
    runner: 'vitest',
    limitSeconds: 3600,
    byName: true,
    commands: (report) => {
      process.env.PROPERTY_RUNS ??= '5000';
      return [
        node(
          'vitest/vitest.mjs',
          'run',
          '--testTimeout=600000',
          '--reporter=default',
          '--reporter=json',
          `--outputFile.json=${report}`,
        ),
      ];
    },
  },
  'nightly-e2e': {
    runner: 'playwright',
    limitSeconds: 5400,
    byName: true,
    commands: async (report) => {
      process.env.CHROMIUM_PATH = await ensureChromium();
      process.env.PLAYWRIGHT_JSON_OUTPUT_NAME = report;
      process.env.THREEPOINT_NIGHTLY = '1';
      await buildWhenStale();
      return [node('@playwright/test/cli.js', 'test', '--grep', '@nightly', '--reporter=list,json')];
    },
  },
};

const seconds = (start) => `${((performance.now() - start) / 1000).toFixed(1)} s`;

async function runStage(name) {
  const { commands, runner, limitSeconds = 600 } = stages[name];
  const report = join(reports, `${name}.${runner === 'pytest' ? 'xml' : 'json'}`);
  const problems = [];
  const start = performance.now();
  console.log(`\n── ${name} ${'─'.repeat(Math.max(3, 70 - name.length))}`);
  try {
    for (const [command, ...args] of await commands(report)) {
      const { code, timedOut } = await run(command, args, { limitSeconds });
      if (timedOut) problems.push(`stopped after ${limitSeconds} s`);
      else if (code !== 0) problems.push(`exit code ${code}`);
    }
  } catch (error) {
    console.error(error instanceof SetupError ? error.message : error);
    problems.push(error.message.split('\n')[0]);
  }
  const results = (runner && readResults(runner, report)) ?? { passed: 0, failed: 0, skipped: 0 };
  if (results.failed === 0 && runner && results.passed === 0) problems.push('no test ran');
  // A stage that failed without a failing test (types, lint, a crash) counts as one, so that the last line cannot hide it.
  if (results.failed === 0 && problems.length > 0) results.failed = 1;
  if (results.failed > 0 && problems.length === 0) problems.push(`${results.failed} failed`);
  return { name, results, problems, counted: Boolean(runner), time: seconds(start) };
}

function printSummary(outcomes, start) {
  console.log(`\n── summary ${'─'.repeat(63)}`);
  for (const { name, results, problems, counted, time } of outcomes) {
    const words = [counted ? countLine(results) : '', ...problems].filter(Boolean).join('; ');
    console.log(`${problems.length === 0 ? '✓' : '✗'} ${name.padEnd(14)}${time.padStart(8)}  ${words}`);
  }
  const failed = outcomes.filter(({ problems }) => problems.length > 0).map(({ name }) => name);
  console.log(`\n${failed.length === 0 ? 'Everything passed' : `Failed: ${failed.join(', ')}`} in ${seconds(start)}.`);
  const total = { passed: 0, failed: 0, skipped: 0 };
  for (const { results } of outcomes) for (const kind of Object.keys(total)) total[kind] += results[kind];
  console.log(countLine(total));
  return failed.length === 0 ? 0 : 1;
}

await main(async () => {
  const start = performance.now();
  const named = process.argv.slice(2);
  const unknown = named.filter((name) => !(name in stages));
  if (unknown.length > 0) {
    throw new SetupError(`No stage is called ${unknown.join(', ')}; there are: ${Object.keys(stages).join(', ')}`);
  }
  const chosen = named.length > 0 ? named : Object.keys(stages).filter((name) => !stages[name].byName);
  await ensureInstalled();
  rmSync(reports, { recursive: true, force: true });
  mkdirSync(reports, { recursive: true });
  const outcomes = [];
  for (const name of chosen) outcomes.push(await runStage(name));
  return printSummary(outcomes, start);
});
