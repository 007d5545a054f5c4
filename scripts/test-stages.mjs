import { join } from 'node:path';
import { buildWhenStale } from './build.mjs';
import { ensureChromium } from './chromium.mjs';
import { pythonEnvironment } from './python-environment.mjs';

const node = (script, ...args) => [process.execPath, join('node_modules', script), ...args];

const pytest = async ({ extras, marker, report }) => {
  const python = await pythonEnvironment({ extras });
  return [[python, '-m', 'pytest', 'training', '-m', marker, '-p', 'no:cacheprovider', `--junitxml=${report}`]];
};

const vitest = (report, ...args) => [
  node('vitest/vitest.mjs', 'run', ...args, '--reporter=default', '--reporter=json', `--outputFile.json=${report}`),
];

/**
 * Returns the commands of browser tests: 'day' runs untagged tests, the others those with that tag
 * (playwright.config.ts).
 */
const playwright = (tests) => async (report) => {
  process.env.CHROMIUM_PATH = await ensureChromium();
  process.env.PLAYWRIGHT_JSON_OUTPUT_NAME = report;
  process.env.THREEPOINT_TESTS = tests;
  await buildWhenStale();
  return [node('@playwright/test/cli.js', 'test', '--reporter=list,json')];
};

/**
 * The time [s] after which a stage of each suite is stopped. It ends a stage that hangs, hence it is at least twice as
 * long as the longest stage takes on two cores that others use too.
 */
export const limitsSeconds = { day: 600, full: 1200, training: 1200, nightly: 5400 };

/**
 * The stages: commands (`report`: the file for the runner's results), runner, and suite: 'day' (npm test), 'full' (npm
 * run test:full), 'training' or 'nightly'. `singleCore`: uses one core, so that another such stage can run at the same
 * time. `waits`: uses all cores but waits for servers and sockets, so that another stage can use one core. `after`: a
 * stage that writes the same folders, and ends before this one begins. `chosen`: the unit tests that it runs, by tag.
 */
export const stages = {
  // The longest stages come first: two single-core stages run at the same time.
  // The packages, built as they are published: their parts, types, documents, and the sizes of the library's entries.
  library: {
    suite: 'day',
    singleCore: true,
    commands: () => [
      ...['build-library', 'build-rooms', 'check-library-package'].map((name) => [
        process.execPath,
        `scripts/${name}.mjs`,
      ]),
      ...['dist-library', 'dist-rooms'].flatMap((folder) => [
        node('publint/src/cli.js', folder, '--strict'),
        node('@arethetypeswrong/cli/dist/index.js', '--pack', folder, '--profile', 'esm-only', '--quiet'),
      ]),
    ],
  },
  types: {
    suite: 'day',
    singleCore: true,
    commands: () => [node('typescript/bin/tsc', '--noEmit')],
  },
  python: {
    suite: 'day',
    singleCore: true,
    runner: 'pytest',
    commands: (report) => pytest({ extras: [], marker: 'not training', report }),
  },
  // The built page, as the browser tests load it.
  page: {
    suite: 'day',
    singleCore: true,
    async commands() {
      await buildWhenStale();
      return [];
    },
  },
  // Core is compiled without the browser's types and without ambient ones: window, performance and console are
  // undefined. The service worker is compiled with a worker's types.
  'core-types': {
    suite: 'day',
    singleCore: true,
    commands: () =>
      ['core', 'worker'].map((part) => node('typescript/bin/tsc', '--noEmit', '-p', `tsconfig.${part}.json`)),
  },
  lint: { suite: 'day', singleCore: true, commands: () => [node('@biomejs/biome/bin/biome', 'check', '.')] },
  dependencies: {
    suite: 'day',
    singleCore: true,
    commands: () => [
      node(
        ...['dependency-cruiser/bin/dependency-cruise.mjs', '--config', '.dependency-cruiser.mjs'],
        ...['src', 'server', 'tests', 'e2e', 'bench'],
      ),
      [process.execPath, 'scripts/check-dependencies.mjs'],
    ],
  },
  unit: {
    suite: 'day',
    waits: true,
    runner: 'vitest',
    chosen: (tags) => !tags.includes('full'),
    commands: (report) => vitest(report, '--tags-filter=!full'),
  },
  e2e: { suite: 'day', runner: 'playwright', commands: playwright('day') },
  // A user's pages, compiled against the packages with every supported module resolution, and programs for Node.
  'library-use': {
    suite: 'full',
    singleCore: true,
    after: 'library',
    commands: () => ['build-packages', 'check-library-use'].map((name) => [process.execPath, `scripts/${name}.mjs`]),
  },
  // The reference of all public packages: every link in a comment leads somewhere.
  reference: {
    suite: 'full',
    singleCore: true,
    commands: () => [node('typedoc/bin/typedoc', '--treatWarningsAsErrors')],
  },
  'unit-full': {
    suite: 'full',
    waits: true,
    runner: 'vitest',
    chosen: (tags) => tags.includes('full'),
    // Most files have no test with that tag: they are read, not loaded.
    commands: (report) => vitest(report, '--tags-filter=full', '--experimental.preParse'),
  },
  'e2e-full': { suite: 'full', runner: 'playwright', commands: playwright('full') },
  'e2e-realtime': { suite: 'full', runner: 'playwright', commands: playwright('realtime') },
  training: {
    suite: 'training',
    runner: 'pytest',
    commands: (report) => pytest({ extras: ['train'], marker: 'training', report }),
  },
  // Every unit test again, with more cases of each property and longer runs.
  'unit-nightly': {
    suite: 'nightly',
    runner: 'vitest',
    commands: (report) => {
      process.env.PROPERTY_RUNS ??= '5000';
      process.env.STUDY_KILLS ??= '1000';
      return vitest(report, '--testTimeout=600000');
    },
  },
  'e2e-nightly': { suite: 'nightly', runner: 'playwright', commands: playwright('nightly') },
};

/** Returns the names of the stages of a suite, in order. */
export const stagesOf = (suite) => Object.keys(stages).filter((name) => stages[name].suite === suite);
