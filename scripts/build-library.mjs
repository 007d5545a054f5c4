// Builds the package “threepoint” into dist-library/: ESM with source maps, types, the learned network's weights, the
// models for the runtime with their model card, the mannequin, and the sources that editors open. `npm pack
// ./dist-library` makes the tarball.
import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, join, posix, relative } from 'node:path';
import { rolldown } from 'rolldown';
import { packageCollector, writeLicences } from './licences.mjs';
import { root, run, SetupError } from './run-command.mjs';
import { buildPackage } from './source-hash.mjs';

const out = join(root, 'dist-library');
/** The manifest of the workspace, whose exports are sources; those of the build are in `publishConfig`. */
const own = JSON.parse(readFileSync(join(root, 'src/threepoint/package.json'), 'utf8'));

/** Returns the source file of each published entry of a package, by the name of its built file. */
export const entriesOf = (folder, { exports, publishConfig }) =>
  Object.fromEntries(
    Object.entries(publishConfig.exports).flatMap(([name, { default: built }]) =>
      built ? [[built.slice(2, -3), join(root, folder, exports[name])]] : [],
    ),
  );
const entries = entriesOf('src/threepoint', own);
/** Whether a module is of a peer, which no bundle contains. */
export const external = (id) =>
  Object.keys(own.peerDependencies).some((name) => id === name || id.startsWith(`${name}/`));

/** Files of the package other than code: path in the package to path in the repository. */
const copied = {
  'models/learned.bin': 'public/models/learned.bin',
  'models/learned.json': 'public/models/learned.json',
  'models/learned.onnx': 'public/models/learned.onnx',
  'models/paper.json': 'public/models/paper.json',
  'models/paper.onnx': 'public/models/paper.onnx',
  'avatars/mannequin.vrm': 'public/avatars/mannequin.vrm',
  LICENSE: 'LICENSE',
};

/** Returns the changelog of a package: its own, or before its second release that of all packages. */
export function changelogOf(folder) {
  const file = `${folder}/CHANGELOG.md`;
  return existsSync(join(root, file)) ? file : 'CHANGELOG.md';
}

/** The documents of the package: path in the package to path in the repository. */
const documents = {
  'README.md': 'src/threepoint/README.md',
  'models/README.md': 'src/threepoint/model-card.md',
  'models/accuracy.md': 'docs/accuracy.md',
  'CHANGELOG.md': changelogOf('src/threepoint'),
};

/**
 * Returns the manifest to publish: without sources and internal rooms. It has no dependencies: all but the peers is
 * bundled.
 */
function published() {
  const { private: _, devDependencies: __, dependencies: ___, publishConfig, ...rest } = own;
  const { engines } = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));
  return {
    ...rest,
    ...publishConfig,
    engines,
    // The worker's modules answer messages; a bundler would drop the others' imports for side effects.
    sideEffects: ['./onnx-worker.js', './onnx/inference-worker.js'],
  };
}

/** Reads `MODULE?bundled` as the text of that module in one file, with all that it imports. */
const workersAsText = {
  name: 'workers-as-text',
  load: {
    filter: { id: /\?bundled$/ },
    handler: async (id) => ({ code: await workerCode(id.replace('?bundled', '')), moduleType: 'text' }),
  },
};

/** Returns the code of a worker as one module without imports, which a worker without an address cannot resolve. */
async function workerCode(module) {
  const build = await bundle({ worker: module }, []);
  const { output } = await build.generate({ format: 'esm', minify: true, codeSplitting: false });
  await build.close();
  if (output.length !== 1) throw new SetupError(`The worker ${module} is ${output.length} files; it must be one.`);
  return output[0].code;
}

/** The folders of the packages in the library and in its worker. */
const packages = new Set();

/**
 * The modules that read a file or start a worker by its address, and those that the package has instead: some bundlers
 * drop files that code references by URL, and a page would then stay with its fallback.
 */
const alias = Object.fromEntries(
  ['weights', 'mannequin', 'validator'].map((name) => [
    `./bundled/${name}`,
    join(root, `scripts/library/embedded-${name}.ts`),
  ]),
);

/**
 * What gltf-validator looks for in Node: there it would call `require`, which a module has not, and Parcel installs
 * packages for the others. Without them it runs in Node as in a browser.
 */
const withoutNode = Object.fromEntries(
  ['process', 'Buffer', '__dirname', '__filename'].map((name) => [name, 'undefined']),
);

/** Bundles the entries; `input` maps the name of each entry to its source file. */
async function bundle(input, outside = external) {
  return rolldown({
    input,
    cwd: root,
    platform: 'browser',
    external: outside,
    resolve: { alias },
    moduleTypes: { '.bin': 'binary', '.vrm': 'binary' },
    plugins: [workersAsText, packageCollector(packages)],
    tsconfig: join(root, 'tsconfig.json'),
    transform: { define: withoutNode },
  });
}

/** Modules from outside the library's folder, by their names in the build: npm packs no folder node_modules. */
const movedModules = {
  'public/models/learned.bin': 'learned-weights',
  'public/avatars/mannequin.vrm': 'mannequin',
  'avatar/file/avatar-check-worker.ts_bundled': 'validator',
  'public/models/learned.json': 'api/learned-contract',
  'node_modules/valibot/dist/index': 'bundled/valibot',
  'node_modules/gltf-validator/module': 'bundled/gltf-validator',
  'node_modules/gltf-validator/gltf_validator.dart': 'bundled/gltf-validator-dart',
  '_virtual/_rolldown/runtime': 'bundled/runtime',
};

/**
 * Writes each entry as one minified file into min/, for pages with an import map or a content delivery network: there
 * each module is a request. Files that load on demand stay those of the modules.
 */
async function writeBundles() {
  const onDemand = {
    name: 'on-demand',
    resolveId: {
      filter: { id: /\/(learned-weights|mannequin)\.js$/ },
      handler: (id) => ({ id: `../${basename(id)}`, external: 'absolute' }),
    },
  };
  for (const name of Object.keys(entries)) {
    const build = await rolldown({
      input: join(out, `${name}.js`),
      platform: 'browser',
      external,
      plugins: [onDemand],
    });
    await build.write({ format: 'esm', file: join(out, 'min', `${name}.js`), minify: true, codeSplitting: false });
    await build.close();
  }
}

/** The path of the built package's folder in the paths of source maps. */
const sourcesFolder = 'src/threepoint';

/**
 * Writes a file for each module. A bundler drops modules that a page does not use; it would keep the top level of a
 * larger file.
 */
async function writeCode() {
  const build = await bundle(entries);
  await build.write({
    format: 'esm',
    dir: out,
    preserveModules: true,
    preserveModulesRoot: join(root, sourcesFolder),
    entryFileNames: ({ name }) => `${movedModules[name] ?? name.replace('scripts/library/', 'api/')}.js`,
    sourcemap: true,
    sourcemapPathTransform: (source, map) => sourceInPackage(join(dirname(map), source), map),
  });
  await build.close();
  // Parcel opens the sources of these maps, which the package has not.
  for (const name of ['gltf-validator', 'gltf-validator-dart']) {
    const file = join(out, 'bundled', `${name}.js`);
    writeFileSync(file, readFileSync(file, 'utf8').replace(/^\/\/# sourceMappingURL=.*$/m, ''));
    rmSync(`${file}.map`);
  }
}

/** Returns the path of a source file in the package, relative to the map that names it; others keep their path. */
function sourceInPackage(source, map) {
  const own = relative(join(root, sourcesFolder), source);
  return own.startsWith('..') ? relative(dirname(map), source) : relative(dirname(map), join(out, 'src', own));
}

/** Writes the compiler's declarations, a file for each module, and the sources that their maps name. */
async function writeTypes() {
  const types = join(out, 'types');
  await writeDeclarations('tsconfig.library.json', types);
  for (const file of readdirSync(types, { recursive: true })) {
    if (file.endsWith('.d.ts.map')) writeDeclarationMap(join(types, file));
  }
}

/** Writes the declarations of a project into `types`, with the full file names that Node's resolution requires. */
export async function writeDeclarations(config, types) {
  rmSync(types, { recursive: true, force: true });
  const { code } = await run(process.execPath, ['node_modules/typescript/bin/tsc', '-p', config, '--outDir', types]);
  if (code !== 0) throw new SetupError(`The types of ${config} could not be written: exit code ${code}.`);
  for (const file of readdirSync(types, { recursive: true })) {
    const path = join(types, file);
    if (!file.endsWith('.d.ts')) continue;
    const fullName = (module) => (existsSync(join(dirname(path), module)) ? `${module}/index.js` : `${module}.js`);
    const declarations = readFileSync(path, 'utf8').replace(
      /(\b(?:from|import)\s*\(?\s*['"])(\.{1,2}\/[^'"]+?)(?=['"])/g,
      (_, before, module) => before + fullName(module),
    );
    writeFileSync(path, declarations);
  }
}

/** Writes the reference of these source files as reference.json, which typedoc and other programs read. */
export async function writeReference(folder, sources) {
  const entries = sources
    .filter((source) => !source.endsWith('onnx-worker.ts'))
    .flatMap((path) => ['--entryPoints', path]);
  const output = ['--json', join(folder, 'reference.json'), '--pretty', 'false', '--skipErrorChecking'];
  const typedoc = ['node_modules/typedoc/bin/typedoc', ...output, '--logLevel', 'Error', ...entries];
  const { code } = await run(process.execPath, typedoc);
  if (code !== 0) throw new SetupError(`The reference of ${folder} could not be written: exit code ${code}.`);
}

/** Copies the sources of a declaration map into the package, where editors open them, and lets the map name them. */
function writeDeclarationMap(path) {
  const map = JSON.parse(readFileSync(path, 'utf8'));
  const sources = map.sources.map((source) => join(dirname(path), source));
  for (const source of sources) {
    const copy = join(dirname(path), sourceInPackage(source, path));
    mkdirSync(dirname(copy), { recursive: true });
    copyFileSync(source, copy);
  }
  writeFileSync(path, JSON.stringify({ ...map, sources: sources.map((source) => sourceInPackage(source, path)) }));
}

/**
 * Returns a document with links that lead to files of the package. What a link names that the package lacks stays as
 * text. `files`: path in the package to path in the repository, of the document `to` and of all that links may name.
 */
export function documentInPackage(text, to, files) {
  const inPackage = Object.fromEntries(Object.entries(files).map(([target, source]) => [source, target]));
  return text.replace(/!?\[([^\]]*)\]\(([^)\s]+)\)/g, (link, label, target) => {
    if (/^([a-z]+:|#)/.test(target)) return link;
    const [path, anchor] = target.split('#');
    const found = inPackage[posix.join(posix.dirname(files[to]), path)];
    if (found === undefined) return label;
    return `[${label}](${posix.relative(posix.dirname(to), found)}${anchor === undefined ? '' : `#${anchor}`})`;
  });
}

/** Returns the table of the networks' errors, as their contracts state them. */
function errorTable() {
  const contracts = ['learned', 'paper'].map((name) =>
    JSON.parse(readFileSync(join(root, `public/models/${name}.json`), 'utf8')),
  );
  const rows = contracts.flatMap(({ errors }) => Object.entries(errors));
  const joints = Object.keys(rows[0][1]);
  const line = (cells) => `| ${cells.join(' | ')} |`;
  return [
    line(['error [cm]', ...joints]),
    line(['---', ...joints.map(() => '---')]),
    ...new Map(rows.map(([what, errors]) => [what, line([what, ...joints.map((joint) => errors[joint])])])).values(),
  ].join('\n');
}

function writeFiles() {
  for (const [to, from] of Object.entries(copied)) {
    mkdirSync(dirname(join(out, to)), { recursive: true });
    copyFileSync(join(root, from), join(out, to));
  }
  for (const [to, from] of Object.entries(documents)) {
    const text = readFileSync(join(root, from), 'utf8').replace('<!-- errors -->', errorTable);
    writeFileSync(join(out, to), documentInPackage(text, to, { ...copied, ...documents }));
  }
  writeFileSync(join(out, 'package.json'), `${JSON.stringify(published(), null, 2)}\n`);
  writeLicences(out, packages);
}

export const buildLibrary = () =>
  buildPackage('dist-library', async () => {
    rmSync(out, { recursive: true, force: true });
    await writeCode();
    await writeBundles();
    await writeTypes();
    await writeReference(out, Object.values(entries));
    writeFiles();
  });
