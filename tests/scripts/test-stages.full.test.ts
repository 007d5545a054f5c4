import { spawnSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { describe, expect, onTestFinished, test, vi } from 'vitest';
import { stages } from '../../scripts/test-stages.mjs';

// The runners are asked for their lists, seven of them: that takes its time.
const root = fileURLToPath(new URL('../..', import.meta.url));

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
    for (const name of ['THREEPOINT_TESTS', 'PROPERTY_RUNS', 'STUDY_KILLS']) vi.stubEnv(name, undefined);
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
});
