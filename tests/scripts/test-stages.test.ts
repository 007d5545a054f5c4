import { readdirSync, readFileSync } from 'node:fs';
import { describe, expect, onTestFinished, test, vi } from 'vitest';
import { stages, stagesOf } from '../../scripts/test-stages.mjs';

const text = (path: string) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');

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

  test('by day compile by every configuration of the compiler that there is', () => {
    const commands = [...stages.types.commands(), ...stages['core-types'].commands()].flat();
    const configurations = readdirSync(new URL('../..', import.meta.url)).filter((file) =>
      /^tsconfig\.\w+\.json$/.test(file),
    );
    expect(configurations.length).toBeGreaterThan(0);
    // The stage of the library has its own, by the script that builds it.
    const compiled = [...commands, ...(text('scripts/build-library.mjs').match(/tsconfig\.\w+\.json/g) ?? [])];
    expect(compiled).toEqual(expect.arrayContaining(configurations));
  });

  test('by day, in full and of training are what a change must pass', () => {
    const [, called] = /^for script in (.+); do$/m.exec(text('.ci/run')) ?? [];
    expect(called?.split(' ')).toEqual(['test', 'test:full', 'test:training']);
  });
});

describe('unit tests', () => {
  test('look further by night: what asks for the night is told of it', async () => {
    for (const name of ['THREEPOINT_TESTS', 'PROPERTY_RUNS', 'THREEPOINT_NIGHTLY']) vi.stubEnv(name, undefined);
    // The next file of this process is to load its modules by day.
    onTestFinished(() => {
      vi.unstubAllEnvs();
      vi.resetModules();
    });
    vi.resetModules();
    await stages['unit-nightly'].commands('report.json');
    expect((await import('../nightly')).isNightly).toBe(true);
  });
});
