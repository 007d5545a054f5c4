import { spawnSync } from 'node:child_process';
import { readFileSync, symlinkSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { cruise, type ICruiseResult } from 'dependency-cruiser';
import extractDepcruiseOptions from 'dependency-cruiser/config-utl/extract-depcruise-options';
import extractTsConfig from 'dependency-cruiser/config-utl/extract-ts-config';
import { describe, expect, test } from 'vitest';
import { directoryWith } from './temporary-directory';

const root = fileURLToPath(new URL('..', import.meta.url));

/** Creates a project of these files alone, under the repository's rules. */
function projectOf(files: Readonly<Record<string, string>>): string {
  const plugins = ['scripts/no-chance-in-core.grit', 'scripts/no-unused-result.grit'];
  const ours = ['biome.json', ...plugins, 'tsconfig.json', 'package.json'];
  const directory = directoryWith({
    ...Object.fromEntries(ours.map((file) => [file, readFileSync(join(root, file))])),
    ...files,
  });
  symlinkSync(join(root, 'node_modules'), join(directory, 'node_modules'), 'junction');
  return directory;
}

/** The rules, loaded once in this process: a new process for each project would take a second to start. */
const importRules = await extractDepcruiseOptions(join(root, '.dependency-cruiser.mjs'));
const tsConfig = extractTsConfig(join(root, 'tsconfig.json'));

/** Cruises a project of these files; returns the broken rules as pairs of the importing file and the rule's name. */
async function violationsIn(files: Readonly<Record<string, string>>): Promise<(readonly [string, string])[]> {
  const folders = [...new Set(Object.keys(files).map((path) => path.split('/')[0] as string))];
  const options = { ...structuredClone(importRules), baseDir: projectOf(files) };
  const { output } = await cruise(folders, options, undefined, { tsConfig });
  const { modules, summary } = output as ICruiseResult;
  expect(modules.map(({ source }) => source)).toEqual(expect.arrayContaining(Object.keys(files)));
  return summary.violations.map(({ from, rule }) => [from, rule.name] as const);
}

describe('the import rules', () => {
  const empty = 'export {};\n';

  const forbidden: readonly (readonly [fact: string, rule: string, from: string, to: string, names?: string])[] = [
    ['the library knows no rooms', 'package-threepoint', 'src/threepoint/xr/a.ts', '../../rooms/client/b'],
    ['rooms know no game', 'package-threepoint-rooms', 'src/rooms/room/a.ts', '../../games/ball/b'],
    ['the study knows no rooms', 'package-threepoint-study', 'src/study/server/a.ts', '../../rooms/server/b'],
    ['nor the server that mounts it', 'package-threepoint-study', 'src/study/server/a.ts', '../../../server/b'],
    ['parts of panels know no page', 'package-threepoint-ui', 'src/ui/a.ts', '../page/shell/b'],
    ['the server draws nothing', 'package-threepoint-server', 'server/a.ts', '../src/page/scene/b'],
    ['math knows no body', 'src-threepoint-core-math', 'src/threepoint/core/math/a.ts', '../body/b'],
    [
      'not even a type',
      'src-threepoint-core-tracking',
      'src/threepoint/core/tracking/a.ts',
      '../estimation/b',
      'type { B } from',
    ],
    ['adapters do not meet', 'src-threepoint-avatar', 'src/threepoint/avatar/a.ts', '../xr/b'],
    ['the results page takes no part in a study', 'src-study-pages', 'src/study/pages/a.ts', '../participant/b'],
    ['a room of a package is known', 'rooms-are-known', 'src/rooms/extra/a.ts', '../room/b'],
    ['core imports no package', 'rules-are-pure', 'src/threepoint/core/math/a.ts', 'three'],
    ['nor do the games', 'rules-are-pure', 'src/games/ball/a.ts', 'socket.io-client'],
    ['core imports no Node', 'browsers-have-no-node', 'src/threepoint/core/math/a.ts', 'node:fs'],
    [
      'the face of the library draws nothing',
      'library-entries-stay-apart',
      'src/threepoint/api/index.ts',
      '../avatar/b',
    ],
    ['and has no runtime', 'library-entries-stay-apart', 'src/threepoint/api/body.ts', '../onnx/session'],
    ['nor does what draws', 'library-draws-without-runtime', 'src/threepoint/api/three.ts', './onnx'],
    ['the polyfill draws nothing', 'library-polyfill-draws-nothing', 'src/threepoint/api/polyfill.ts', '../avatar/b'],
    ['a game knows no shell', 'activities-are-strangers', 'src/page/ball/a.ts', '../shell/b'],
    ['nor the other game', 'activities-are-strangers', 'src/page/ball/a.ts', '../archery/b'],
    ['the scene knows no game', 'scene-draws-for-activities', 'src/page/scene/a.ts', '../archery/b'],
    ['three stays where things are drawn', 'three-draws', 'src/rooms/client/a.ts', 'three'],
    ['and so do its types', 'three-draws', 'src/threepoint/onnx/a.ts', 'three', 'type { Vector3 } from'],
    ['and its VRM loader', 'three-draws', 'src/rooms/client/a.ts', '@pixiv/three-vrm'],
    ['the runtime has one room', 'onnxruntime-infers', 'src/page/main.ts', 'onnxruntime-web/wasm'],
    ['the database has one folder', 'sqlite-stores', 'server/a.ts', '@photostructure/sqlite'],
    [
      'the page reaches the server over the network',
      'browser-code-knows-no-server',
      'src/page/shell/a.ts',
      '../../http/b',
    ],
    ['the page runs in a browser', 'browsers-have-no-node', 'src/rooms/client/a.ts', 'node:net'],
    ['what ships needs no tests', 'shipped-code-knows-no-tests', 'src/rooms/client/a.ts', '../../../tests/b'],
    ['nor a tool', 'shipped-packages-are-no-tools', 'server/a-worker.mjs', 'fast-check'],
    ['nor does the library', 'shipped-packages-are-no-tools', 'src/threepoint/xr/a.ts', 'fast-check'],
  ];

  test('refuse each import that the design forbids', async () => {
    const files: Record<string, string> = {};
    const broken = forbidden.map(([fact, rule, importer, imported, names = ''], index) => {
      // Each import has a file of its own.
      const from = importer.replace(/\/a\.ts$/, `/a-${index}.ts`);
      files[from] = `import ${names} '${imported}';`;
      if (imported.startsWith('.')) files[`${join(dirname(importer), imported)}.ts`] = empty;
      return { fact, violation: [from, rule] };
    });
    const violations = await violationsIn(files);
    for (const { fact, violation } of broken) expect(violations, fact).toContainEqual(violation);
  });

  test('imports lead somewhere, and no circles (imports-resolve, no-cycles)', async () => {
    const files = { 'src/ui/a.ts': "import './b';", 'src/ui/b.ts': "import './a';\nimport './gone';" };
    const rules = (await violationsIn(files)).map(([, rule]) => rule);
    expect([...new Set(rules)].toSorted()).toEqual(['imports-resolve', 'no-cycles']);
  });

  test('what the design allows breaks none', async () => {
    const allowed = {
      'src/threepoint/core/math/vec3.ts': empty,
      'src/threepoint/core/tracking/tracking-frame.ts': "import '../math/vec3';",
      'src/threepoint/core/body/skeleton.ts': "import '../math/vec3';",
      'src/threepoint/core/estimation/estimators.ts':
        "import '../math/vec3';\nimport '../body/skeleton';\nimport '../tracking/tracking-frame';",
      'src/threepoint/avatar/mirror.ts': "import '../core/body/skeleton';",
      'src/threepoint/onnx/model-files.ts': empty,
      'src/threepoint/api/body.ts': "import '../core/estimation/estimators';\nimport '../onnx/model-files';",
      'src/threepoint/api/three.ts': "import './body';\nimport '../avatar/mirror';",
      'src/rooms/protocol/messages.ts': "import '../../threepoint/core/math/vec3';",
      'src/rooms/room/room.ts': "import '../protocol/messages';",
      'src/games/ball/rules.ts': "import '../../rooms/room/room';",
      'src/http/router.ts': "import 'node:http';",
      'src/study/statistics/a.ts': empty,
      'src/study/model/plan/plan.ts': empty,
      'src/study/model/results/results.ts': "import '../plan/plan';\nimport '../../statistics/a';",
      'src/study/server/routes/dispatcher.ts': "import '../../model/plan/plan';\nimport '../../../http/router';",
      'src/page/scene/renderer.ts': empty,
      'src/page/studio/studio.ts': "import '../scene/renderer';",
      'src/page/activity/activity.ts': empty,
      'src/page/shell/activity-registry.ts': "import '../studio/studio';\nimport '../activity/activity';",
      'src/page/shell/stage.ts': "import './activity-registry';\nimport '../../threepoint/avatar/mirror';",
      'server/main.ts':
        "import 'node:http';\nimport '../src/games/ball/rules';\nimport '../src/study/server/routes/dispatcher';",
    };
    expect(await violationsIn(allowed)).toEqual([]);
  });
});

/** Returns the linter's report on these files, from one run. */
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
  const inCore = forbidden.map((code, index) => [`src/threepoint/core/math/case-${index}.ts`, code] as const);
  const outside = forbidden.map((code, index) => [`src/rooms/client/case-${index}.ts`, code] as const);
  const mathematics = [
    'src/threepoint/core/math/mathematics.ts',
    'export const half = (x: number) => Math.sin(x) / 2;\n',
  ] as const;
  const report = lint(Object.fromEntries([...inCore, ...outside, mathematics]));
  // Each finding starts with its file, line and column.
  const refused = report.split(/^(?=src\/\S+:\d+:\d+ )/m).flatMap((finding) => {
    if (!finding.includes('core has no chance')) return [];
    return finding.slice(0, finding.indexOf(':'));
  });
  expect([...new Set(refused)].sort()).toEqual(inCore.map(([path]) => path));
});
