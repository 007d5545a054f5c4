import { spawnSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, onTestFinished, test, vi } from 'vitest';
import { choices } from '../../playwright.config';
import { stages, stagesOf } from '../../scripts/test-stages.mjs';

const root = fileURLToPath(new URL('../..', import.meta.url));
const text = (path: string) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');

describe('the suites', () => {
  const { scripts } = JSON.parse(text('package.json')) as { scripts: Record<string, string> };
  /** Returns the stages that an npm script runs. */
  const run = (script: string): string[] => {
    const named = scripts[script]?.split('scripts/test.mjs ')[1]?.split(' ') ?? ['day'];
    return named.flatMap((name) => (name in stages ? [name] : stagesOf(name)));
  };

  test('have every stage between them, each once', () => {
    const all = ['test', 'test:full', 'test:training', 'nightly'].flatMap(run);
    expect(all.toSorted()).toEqual(Object.keys(stages).toSorted());
  });

  test('by day compile by every configuration of the compiler that there is', () => {
    const commands = [...stages.types.commands(), ...stages['core-types'].commands()].flat();
    const configurations = readdirSync(new URL('../..', import.meta.url)).filter((file) =>
      /^tsconfig\.\w+\.json$/.test(file),
    );
    expect(configurations.length).toBeGreaterThan(0);
    // The stage of the packages runs scripts that compile.
    const scripts = stages.library
      .commands()
      .flat()
      .filter((argument: string) => argument.startsWith('scripts/'));
    const compiled = [
      ...commands,
      ...scripts.flatMap((path: string) => text(path).match(/tsconfig\.\w+\.json/g) ?? []),
    ];
    expect(compiled).toEqual(expect.arrayContaining(configurations));
  });

  test('by day, in full and of training are what a change must pass', () => {
    const [, called] = /^for script in (.+); do$/m.exec(text('.ci/run')) ?? [];
    expect(called?.split(' ')).toEqual(['test', 'test:full', 'test:training']);
  });
});

describe('unit tests', () => {
  test('run by day or in full, as their tags say, and all of them by night', async () => {
    for (const tags of [[], ['full']]) {
      expect((['unit', 'unit-full'] as const).filter((name) => stages[name].chosen(tags))).toHaveLength(1);
    }
    const filters = async (name: 'unit' | 'unit-full' | 'unit-nightly') => {
      const [command = []] = await stages[name].commands('report.json');
      return command.filter((argument: string) => argument.startsWith('--tags-filter'));
    };
    for (const name of ['PROPERTY_RUNS', 'STUDY_KILLS']) vi.stubEnv(name, undefined);
    expect(await filters('unit')).toEqual(['--tags-filter=!full']);
    expect(await filters('unit-full')).toEqual(['--tags-filter=full']);
    expect(await filters('unit-nightly')).toEqual([]);
  });

  test('run more cases by night, and know that it is night', async () => {
    for (const name of ['THREEPOINT_TESTS', 'PROPERTY_RUNS', 'THREEPOINT_NIGHTLY']) vi.stubEnv(name, undefined);
    // The next file in this process must load its modules with the default environment.
    onTestFinished(() => {
      vi.unstubAllEnvs();
      vi.resetModules();
    });
    vi.resetModules();
    await stages['unit-nightly'].commands('report.json');
    expect((await import('../nightly')).isNightly).toBe(true);
  });
});

describe('browser tests', () => {
  interface Suite {
    readonly title: string;
    readonly suites?: readonly Suite[];
    readonly specs?: readonly { readonly title: string }[];
  }
  /** Returns the titles of a suite's tests, each after those of the suites around it, as the runner greps them. */
  const titlesIn = ({ title, suites = [], specs = [] }: Suite): string[] =>
    [...specs.map((spec) => spec.title), ...suites.flatMap(titlesIn)].map((inner) => `${title} ${inner}`);

  test('run by day, in full, in real time or by night, each in one of them', { tags: ['full'] }, () => {
    const { status, stdout, stderr } = spawnSync(
      process.execPath,
      ['node_modules/@playwright/test/cli.js', 'test', '--list', '--reporter=json'],
      { cwd: root, encoding: 'utf8', env: { ...process.env, THREEPOINT_TESTS: 'all' }, maxBuffer: 2 ** 26 },
    );
    expect(status, stderr).toBe(0);
    const titles = (JSON.parse(stdout) as { suites: readonly Suite[] }).suites.flatMap(titlesIn);
    const suites = ['day', 'full', 'realtime', 'nightly'].map((name) => {
      const { grep, grepInvert } = choices[name] ?? {};
      return titles.filter((title) => (!grep || grep.test(title)) && !grepInvert?.test(title));
    });
    expect(suites.flat().toSorted()).toEqual(titles.toSorted());
    for (const suite of suites) expect(suite.length).toBeGreaterThan(0);
  });
});
