import { spawnSync } from 'node:child_process';
import { readFileSync, symlinkSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { cruise, type ICruiseResult } from 'dependency-cruiser';
import extractDepcruiseOptions from 'dependency-cruiser/config-utl/extract-depcruise-options';
import extractTsConfig from 'dependency-cruiser/config-utl/extract-ts-config';
import { describe, expect, test } from 'vitest';
import { directoryWith } from './temporary-directory';

const root = fileURLToPath(new URL('..', import.meta.url));

/** A project of these files alone, under the same rules as ours. */
function projectOf(files: Readonly<Record<string, string>>): string {
  const ours = ['biome.json', 'scripts/no-chance-in-core.grit', 'tsconfig.json', 'package.json'];
  const directory = directoryWith({
    ...Object.fromEntries(ours.map((file) => [file, readFileSync(join(root, file))])),
    ...files,
  });
  symlinkSync(join(root, 'node_modules'), join(directory, 'node_modules'), 'dir');
  return directory;
}

/** Read once and used in this process: a new process for each project would spend a second on starting. */
const importRules = await extractDepcruiseOptions(join(root, '.dependency-cruiser.mjs'));
const tsConfig = extractTsConfig(join(root, 'tsconfig.json'));

/** The names of the import rules that these files break, each once. */
async function brokenImportRules(files: Readonly<Record<string, string>>): Promise<string[]> {
  const folders = [...new Set(Object.keys(files).map((path) => path.split('/')[0] as string))];
  const options = { ...structuredClone(importRules), baseDir: projectOf(files) };
  const { output } = await cruise(folders, options, undefined, { tsConfig });
  const { modules, summary } = output as ICruiseResult;
  expect(modules.map(({ source }) => source)).toEqual(expect.arrayContaining(Object.keys(files)));
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
      'the Room knows no game',
      'core-room',
      { 'src/core/room/a.ts': "import '../games/ball/b';", 'src/core/games/ball/b.ts': empty },
    ],
    [
      'not even by a detour',
      'room-reaches-no-game',
      {
        'src/core/room/a.ts': "import '../protocol/b';",
        'src/core/protocol/b.ts': "import '../games/ball/c';",
        'src/core/games/ball/c.ts': empty,
      },
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
    ['which needs nothing else', 'core-statistics-is-pure', { 'src/core/statistics/a.ts': "import 'valibot';" }],
    ['core imports no Node', 'core-is-pure', { 'src/core/math/a.ts': "import 'node:fs';" }],
    ['adapters do not meet', 'adapters-are-strangers', { 'src/ui/a.ts': "import '../xr/b';", 'src/xr/b.ts': empty }],
    [
      'main is the top',
      'main-is-imported-by-none',
      { 'src/app/shell/frame-loop.ts': "import '../main';", 'src/app/main.ts': empty },
    ],
    [
      'adapters know no page',
      'adapters-know-no-page',
      { 'src/ui/a.ts': "import '../app/shell/frame-loop';", 'src/app/shell/frame-loop.ts': empty },
    ],
    [
      'the library knows no page',
      'library-knows-no-page',
      { 'src/lib/index.ts': "import '../app/shell/b';", 'src/app/shell/b.ts': empty },
    ],
    ['and no panel of one', 'library-knows-no-page', { 'src/lib/three.ts': "import '../ui/b';", 'src/ui/b.ts': empty }],
    ['its face has no three', 'three-draws', { 'src/lib/index.ts': "import 'three';" }],
    [
      'not by way of an avatar',
      'library-parts-stay-apart',
      { 'src/lib/index.ts': "import '../avatar/b';", 'src/avatar/b.ts': empty },
    ],
    [
      'nor a runtime',
      'library-parts-stay-apart',
      { 'src/lib/body.ts': "import '../inference/session';", 'src/inference/session.ts': empty },
    ],
    [
      'which drawing does not need either',
      'library-draws-without-runtime',
      { 'src/lib/three.ts': "import './onnx';", 'src/lib/onnx.ts': empty },
    ],
    [
      'nor does the polyfill know three',
      'library-polyfill-draws-nothing',
      { 'src/lib/polyfill.ts': "import '../avatar/b';", 'src/avatar/b.ts': empty },
    ],
    [
      'adapters know no library',
      'adapters-know-no-page',
      { 'src/xr/a.ts': "import '../lib/body';", 'src/lib/body.ts': empty },
    ],
    [
      'a game knows no shell',
      'activities-are-strangers',
      { 'src/app/ball/a.ts': "import '../shell/b';", 'src/app/shell/b.ts': empty },
    ],
    [
      'the study knows no game',
      'activities-are-strangers',
      { 'src/app/study/a.ts': "import '../archery/b';", 'src/app/archery/b.ts': empty },
    ],
    [
      'the results page loads no body',
      'pages-stand-alone',
      { 'src/pages/a.ts': "import '../avatar/b';", 'src/avatar/b.ts': empty },
    ],
    [
      'a file has a room',
      'nothing-loose-in-src',
      { 'src/a.ts': "import './core/math/b';", 'src/core/math/b.ts': empty },
    ],
    [
      'the body knows no tracking',
      'core-body',
      { 'src/core/body/a.ts': "import '../tracking/b';", 'src/core/tracking/b.ts': empty },
    ],
    ['three stays where things are drawn', 'three-draws', { 'src/net/a.ts': "import 'three';" }],
    [
      'and so do its types',
      'three-draws',
      { 'src/inference/a.ts': "import type { Vector3 } from 'three';\nexport type A = Vector3;" },
    ],
    ['and its VRM loader', 'three-draws', { 'src/net/a.ts': "import '@pixiv/three-vrm';" }],
    [
      'the runtime stays behind inference',
      'onnxruntime-infers',
      { 'src/app/main.ts': "import 'onnxruntime-web/wasm';" },
    ],
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
  ])('%s (%s)', async (_, rule, files) => {
    expect(await brokenImportRules(files as Record<string, string>)).toContain(rule);
  });

  test('what the design allows breaks none', async () => {
    const allowed = {
      'src/core/math/vec3.ts': empty,
      'src/core/tracking/tracking-frame.ts': "import '../math/vec3';",
      'src/core/body/skeleton.ts': "import '../math/vec3';",
      'src/core/estimation/estimators.ts':
        "import '../math/vec3';\nimport '../body/skeleton';\nimport '../tracking/tracking-frame';",
      'src/core/study/plan.ts': "import 'valibot';",
      'src/core/statistics/a.ts': "import '@stdlib/stats-base-dists-t-cdf';",
      'src/scene/renderer.ts': "import 'three';",
      'src/avatar/mirror.ts':
        "import 'three';\nimport '@pixiv/three-vrm';\nimport '../scene/renderer';\nimport '../core/body/skeleton';",
      'src/inference/regressor.ts': "import 'onnxruntime-web/wasm';\nimport '../core/estimation/estimators';",
      'src/lib/body.ts': "import '../core/estimation/estimators';\nimport '../inference/model-files';",
      'src/inference/model-files.ts': empty,
      'src/lib/three.ts': "import 'three';\nimport './body';\nimport '../avatar/mirror';",
      'src/lib/onnx.ts': "import '../inference/regressor';",
      'src/app/shell/stage.ts': "import '../../lib/body';\nimport '../studio/studio';\nimport '../../avatar/mirror';",
      'src/app/studio/studio.ts': "import 'three';\nimport '../../scene/renderer';",
      'src/app/main.ts': "import './shell/stage';\nimport '../inference/regressor';",
      'src/pages/results-page.ts': "import '../core/study/plan';",
      'server/main.ts': "import 'node:http';\nimport '../src/core/math/vec3';",
    };
    expect(await brokenImportRules(allowed)).toEqual([]);
  });
});

/** The linter's report on these files, in one run. */
function lint(files: Readonly<Record<string, string>>): string {
  const { stdout, stderr } = spawnSync(
    process.execPath,
    [
      ...[join(root, 'node_modules/@biomejs/biome/bin/biome'), 'lint', '--vcs-enabled=false', '--colors=off'],
      ...['--max-diagnostics=none', ...Object.keys(files)],
    ],
    { cwd: projectOf(files), encoding: 'utf8' },
  );
  const report = `${stdout}${stderr}`;
  expect(report).toContain(`Checked ${Object.keys(files).length} files`);
  return report;
}

test('chance is refused in core, however it is written, and nowhere else', () => {
  const forbidden = [
    'export const roll = () => Math.random();\n',
    "export const roll = () => Math['random']();\n",
    'const { random } = Math;\nexport const roll = () => random();\n',
  ];
  const inCore = forbidden.map((code, index) => [`src/core/math/case-${index}.ts`, code] as const);
  const outside = forbidden.map((code, index) => [`src/net/case-${index}.ts`, code] as const);
  const mathematics = [
    'src/core/math/mathematics.ts',
    'export const half = (x: number) => Math.sin(x) / 2;\n',
  ] as const;
  const report = lint(Object.fromEntries([...inCore, ...outside, mathematics]));
  // Each finding begins with its file, line and column.
  const refused = report.split(/^(?=src\/\S+:\d+:\d+ )/m).flatMap((finding) => {
    if (!finding.includes('core has no chance')) return [];
    return finding.slice(0, finding.indexOf(':'));
  });
  expect([...new Set(refused)].sort()).toEqual(inCore.map(([path]) => path));
});
