import { spawnSync } from 'node:child_process';
import { readFileSync, symlinkSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { directoryWith } from './temporary-directory';

const root = fileURLToPath(new URL('..', import.meta.url));

/** A project of these files alone, under the same rules as ours. */
function projectOf(files: Readonly<Record<string, string>>): string {
  const ours = ['biome.json', 'scripts/no-chance-in-core.grit', 'tsconfig.json', 'tsconfig.core.json', 'package.json'];
  const directory = directoryWith({
    ...Object.fromEntries(ours.map((file) => [file, readFileSync(join(root, file))])),
    ...files,
  });
  symlinkSync(join(root, 'node_modules'), join(directory, 'node_modules'), 'dir');
  return directory;
}

function runTool(directory: string, script: string, ...args: string[]): { code: number | null; output: string } {
  const { status, stdout, stderr } = spawnSync(process.execPath, [join(root, 'node_modules', script), ...args], {
    cwd: directory,
    encoding: 'utf8',
  });
  return { code: status, output: stdout + stderr };
}

/** The names of the import rules that these files break, each once. */
function brokenImportRules(files: Readonly<Record<string, string>>): string[] {
  const folders = [...new Set(Object.keys(files).map((path) => path.split('/')[0] as string))];
  const { output } = runTool(
    projectOf(files),
    'dependency-cruiser/bin/dependency-cruise.mjs',
    '--config',
    join(root, '.dependency-cruiser.mjs'),
    '--output-type',
    'json',
    ...folders,
  );
  const { summary } = JSON.parse(output) as { summary: { violations: { rule: { name: string } }[] } };
  return [...new Set(summary.violations.map(({ rule }) => rule.name))].sort();
}

describe('the import rules', () => {
  const empty = 'export {};\n';

  test.each([
    ['math knows nothing', 'core-math', { 'src/core/math/a.ts': "import '../body/b';", 'src/core/body/b.ts': empty }],
    [
      'not even a type',
      'core-tracking',
      {
        'src/core/tracking/a.ts': "import type { B } from '../estimation/b';\nexport type A = B;",
        'src/core/estimation/b.ts': 'export type B = 1;',
      },
    ],
    ['games know no body', 'core-games', { 'src/core/games/a.ts': "import '../body/b';", 'src/core/body/b.ts': empty }],
    [
      'estimation knows no protocol',
      'core-estimation',
      { 'src/core/estimation/a.ts': "import '../protocol/b';", 'src/core/protocol/b.ts': empty },
    ],
    [
      'a new folder of core is asked about',
      'core-folders-are-known',
      { 'src/core/extra/a.ts': "import '../math/b';", 'src/core/math/b.ts': empty },
    ],
    [
      'core imports no adapter',
      'core-is-pure',
      { 'src/core/math/a.ts': "import '../../scene/b';", 'src/scene/b.ts': empty },
    ],
    ['core imports no package', 'core-is-pure', { 'src/core/math/a.ts': "import 'valibot';" }],
    ['validation stays in the study', 'core-is-pure', { 'src/core/games/a.ts': "import 'valibot';" }],
    ['the study draws nothing', 'core-study-is-pure', { 'src/core/study/a.ts': "import 'three';" }],
    [
      'p-values come from one file',
      'core-study-is-pure',
      { 'src/core/study/plan.ts': "import '@stdlib/stats-base-dists-t-cdf';" },
    ],
    ['which needs nothing else', 'core-statistics-is-pure', { 'src/core/study/statistics.ts': "import 'valibot';" }],
    ['core imports no Node', 'core-is-pure', { 'src/core/math/a.ts': "import 'node:fs';" }],
    ['adapters do not meet', 'adapters-are-strangers', { 'src/ui/a.ts': "import '../xr/b';", 'src/xr/b.ts': empty }],
    ['main is the top', 'nobody-imports-main', { 'src/frame-loop.ts': "import './main';", 'src/main.ts': empty }],
    [
      'adapters do not call the loop',
      'only-main-runs-the-frame-loop',
      { 'src/ui/a.ts': "import '../frame-loop';", 'src/frame-loop.ts': empty },
    ],
    ['three stays where things are drawn', 'three-draws', { 'src/net/a.ts': "import 'three';" }],
    [
      'and so do its types',
      'three-draws',
      { 'src/inference/a.ts': "import type { Vector3 } from 'three';\nexport type A = Vector3;" },
    ],
    ['and its VRM loader', 'three-draws', { 'src/study/a.ts': "import '@pixiv/three-vrm';" }],
    ['the runtime stays behind inference', 'onnxruntime-infers', { 'src/main.ts': "import 'onnxruntime-web/wasm';" }],
    ['sockets stay in net and server', 'socket-io-connects', { 'src/ui/a.ts': "import 'socket.io-client';" }],
    ['the database stays in one file', 'sqlite-stores', { 'server/a.ts': "import '@photostructure/sqlite';" }],
    [
      'the server draws nothing',
      'server-knows-core-alone',
      { 'server/a.ts': "import '../src/scene/b';", 'src/scene/b.ts': empty },
    ],
    [
      'the page imports no server',
      'page-knows-no-server',
      { 'src/net/a.ts': "import '../../server/b';", 'server/b.ts': empty },
    ],
    ['the page runs in a browser', 'page-runs-in-a-browser', { 'src/net/a.ts': "import 'node:net';" }],
    [
      'what ships needs no tests',
      'shipped-code-knows-no-tests',
      { 'src/net/a.ts': "import '../../tests/b';", 'tests/b.ts': empty },
    ],
    ['no circles', 'no-cycles', { 'src/ui/a.ts': "import './b';", 'src/ui/b.ts': "import './a';" }],
    ['imports lead somewhere', 'imports-resolve', { 'src/ui/a.ts': "import './gone';" }],
  ])('%s (%s)', (_, rule, files) => {
    expect(brokenImportRules(files as Record<string, string>)).toContain(rule);
  });

  test('what the design allows breaks none', () => {
    const allowed = {
      'src/core/math/vec3.ts': empty,
      'src/core/tracking/tracking-frame.ts': "import '../math/vec3';",
      'src/core/body/skeleton.ts': "import '../math/vec3';",
      'src/core/estimation/ik.ts':
        "import '../math/vec3';\nimport '../body/skeleton';\nimport '../tracking/tracking-frame';",
      'src/core/study/plan.ts': "import 'valibot';",
      'src/core/study/statistics.ts': "import '@stdlib/stats-base-dists-t-cdf';",
      'src/scene/renderer.ts': "import 'three';",
      'src/avatar/mirror.ts':
        "import 'three';\nimport '@pixiv/three-vrm';\nimport '../scene/renderer';\nimport '../core/body/skeleton';",
      'src/inference/regressor.ts': "import 'onnxruntime-web/wasm';\nimport '../core/estimation/ik';",
      'src/main.ts': "import './avatar/mirror';\nimport './inference/regressor';",
      'server/main.ts': "import 'node:http';\nimport '../src/core/math/vec3';",
    };
    expect(brokenImportRules(allowed)).toEqual([]);
  });
});

describe('no clock and no chance in core', () => {
  const lint = (path: string, code: string) =>
    runTool(
      projectOf({ [path]: code }),
      '@biomejs/biome/bin/biome',
      'lint',
      '--vcs-enabled=false',
      '--colors=off',
      path,
    );

  test.each([
    ['export const now = () => Date.now();', 'core has no clock'],
    ['export const now = () => new Date();', 'core has no clock'],
    ['export const now = () => performance.now();', 'core has no clock'],
    ['export const later = (f: () => void) => setTimeout(f, 10);', 'core never waits'],
    ['export const roll = () => Math.random();', 'core has no chance'],
    ["export const roll = () => Math['random']();", 'core has no chance'],
    ['const { random } = Math;\nexport const roll = () => random();', 'core has no chance'],
    ['export const roll = () => crypto.randomUUID();', 'core has no chance'],
    ['export const roll = () => globalThis.Math.random();', 'core knows no surroundings'],
  ])('%s', (code, message) => {
    const inCore = lint('src/core/math/a.ts', `${code}\n`);
    expect(inCore.code).not.toBe(0);
    expect(inCore.output).toContain(message);
    expect(lint('src/net/a.ts', `${code}\n`).output).not.toContain(message);
  });

  test('mathematics is welcome', () => {
    const { code, output } = lint('src/core/math/a.ts', 'export const half = (x: number) => Math.sin(x) / Math.PI;\n');
    expect(output).toContain('Checked 1 file');
    expect(code).toBe(0);
  });
});

describe('core compiles without a browser and without Node', () => {
  const compile = (code: string) => {
    const directory = projectOf({ 'src/core/math/a.ts': code });
    return runTool(directory, 'typescript/bin/tsc', '--noEmit', '-p', 'tsconfig.core.json');
  };

  test.each([
    'window.innerWidth',
    'performance.now()',
    'console.log(1)',
    'process.env',
    'document.title',
    'fetch("/")',
  ])('%s is unknown there', (expression) => {
    const { code, output } = compile(`export const a = () => ${expression};\n`);
    expect(code).not.toBe(0);
    expect(output).toContain('src/core/math/a.ts(1,');
  });

  test('mathematics compiles', () => {
    expect(compile('export const half = (x: number) => Math.sin(x) / Math.PI;\n')).toEqual({ code: 0, output: '' });
  });
});
