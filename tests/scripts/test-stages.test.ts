import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, onTestFinished, test, vi } from 'vitest';
import { stages, stagesOf } from '../../scripts/test-stages.mjs';

const root = fileURLToPath(new URL('../..', import.meta.url));
const text = (path: string) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');

/** What a program of ours prints as JSON. */
function listed(script: string, args: readonly string[], env: Readonly<Record<string, string>> = {}): unknown {
  const { status, stdout, stderr } = spawnSync(process.execPath, [`${root}node_modules/${script}`, ...args], {
    cwd: root,
    encoding: 'utf8',
    env: { ...process.env, ...env },
    maxBuffer: 2 ** 26,
  });
  expect(status, stderr).toBe(0);
  return JSON.parse(stdout);
}

describe('the suites', () => {
  const { scripts } = JSON.parse(text('package.json')) as { scripts: Record<string, string> };
  /** The stages that an npm script runs. */
  const run = (script: string): string[] => {
    const named = scripts[script]?.split('scripts/test.mjs ')[1]?.split(' ') ?? ['day'];
    return named.flatMap((name) => (name in stages ? [name] : stagesOf(name)));
  };

  test('have every stage between them, each once', () => {
    const all = ['test', 'test:full', 'test:training', 'nightly'].flatMap(run);
    expect(all.toSorted()).toEqual(Object.keys(stages).toSorted());
  });

  test('by day, in full and of training are what a change must pass', () => {
    const [, called] = /^for script in (.+); do$/m.exec(text('.ci/run')) ?? [];
    expect(called?.split(' ')).toEqual(['test', 'test:full', 'test:training']);
  });
});

describe('browser tests', () => {
  interface Suite {
    readonly suites?: readonly Suite[];
    readonly specs?: readonly { readonly id: string; readonly title: string }[];
  }
  const specsOf = ({ suites = [], specs = [] }: Suite): { readonly id: string; readonly title: string }[] => [
    ...specs,
    ...suites.flatMap(specsOf),
  ];
  const chosen = (tests: string) =>
    specsOf(
      listed('@playwright/test/cli.js', ['test', '--list', '--reporter=json'], { THREEPOINT_TESTS: tests }) as Suite,
    );

  test('run by day, in full or by night, each in one of them, and those marked nightly by night', {
    timeout: 60_000,
  }, () => {
    const [all, nightly] = [chosen('all'), chosen('nightly')];
    const suites = [chosen('day'), chosen('full'), nightly];
    const ids = (specs: typeof all) => specs.map(({ id }) => id).toSorted();
    expect(ids(suites.flat())).toEqual(ids(all));
    expect(ids(nightly)).toEqual(ids(all.filter(({ title }) => title.includes('@nightly'))));
    for (const suite of suites) expect(suite.length).toBeGreaterThan(0);
  });
});

describe('unit tests', () => {
  /** The files that a stage runs. */
  const files = async (stage: 'unit' | 'unit-full' | 'unit-nightly'): Promise<string[]> => {
    // A stage tells its runner by the environment what to run.
    for (const name of ['THREEPOINT_TESTS', 'PROPERTY_RUNS']) vi.stubEnv(name, undefined);
    onTestFinished(() => void vi.unstubAllEnvs());
    await stages[stage].commands('report.json');
    const list = listed('vitest/vitest.mjs', ['list', '--filesOnly', '--json']) as { file: string }[];
    return list.map(({ file }) => file).toSorted();
  };

  test('run by day or in full, and all of them by night', { timeout: 60_000 }, async () => {
    const [day, full, nightly] = [await files('unit'), await files('unit-full'), await files('unit-nightly')];
    expect([...day, ...full].toSorted()).toEqual(nightly);
    expect(full.length).toBeGreaterThan(0);
    expect(full.every((file) => file.endsWith('.full.test.ts'))).toBe(true);
  });

  test('look further by night: what asks for the night is told of it', async () => {
    for (const name of ['THREEPOINT_TESTS', 'PROPERTY_RUNS', 'THREEPOINT_NIGHTLY']) vi.stubEnv(name, undefined);
    onTestFinished(() => void vi.unstubAllEnvs());
    vi.resetModules();
    await stages['unit-nightly'].commands('report.json');
    expect((await import('../nightly')).isNightly).toBe(true);
  });
});
