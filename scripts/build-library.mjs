// Builds the package “threepoint” into dist-library/: ESM with source maps, types, the learned network's weights, the
// models for the runtime with their model card, the mannequin, and the sources that editors open. Prints the size of
// each entry and fails if a document states another size. `npm pack ./dist-library` makes the tarball.
import { copyFileSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, join, posix, relative } from 'node:path';
import { brotliCompressSync } from 'node:zlib';
import { rolldown } from 'rolldown';
import { staleSizes } from './library-sizes.mjs';
import { mainOf, root, run, SetupError } from './run-command.mjs';
import { sourceResolution } from './source-condition.mjs';
import { buildPackage } from './source-hash.mjs';

const out = join(root, 'dist-library');
/** The manifest of the workspace; the published one omits what only this repository can resolve. */
const own = JSON.parse(readFileSync(join(root, 'src/threepoint/package.json'), 'utf8'));
/** The source file of each entry, by the name of its built file. */
const entries = Object.fromEntries(
  Object.values(own.exports).flatMap(({ source, default: built }) =>
    source ? [[built.slice(2, -3), join(root, 'src/threepoint', source)]] : [],
  ),
);
const external = (id) => Object.keys(own.peerDependencies).some((name) => id === name || id.startsWith(`${name}/`));

/** Files of the package other than code: path in the package to path in the repository. */
const copied = {
  'models/learned.bin': 'public/models/learned.bin',
  'models/learned.json': 'public/models/learned.json',
  'models/learned.onnx': 'public/models/learned.onnx',
  'models/paper.json': 'public/models/paper.json',
  'models/paper.onnx': 'public/models/paper.onnx',
  'avatars/mannequin.vrm': 'public/avatars/mannequin.vrm',
  LICENSE: 'LICENSE',
  'bundled/gltf-validator-LICENSE.txt': 'node_modules/gltf-validator/LICENSE',
  'bundled/gltf-validator-NOTICES.txt': 'node_modules/gltf-validator/NOTICES',
};

/** The documents of the package: path in the package to path in the repository. */
const documents = {
  'README.md': 'src/threepoint/README.md',
  'models/README.md': 'src/threepoint/model-card.md',
  'models/accuracy.md': 'docs/accuracy.md',
};

/** Returns a manifest's exports without those that only this repository can resolve. */
export function builtExports(exports) {
  const outside = Object.entries(exports).flatMap(([name, target]) => {
    if (typeof target === 'string') return [[name, target]];
    const { source: _, ...built } = target;
    return Object.keys(built).length > 0 ? [[name, built]] : [];
  });
  return Object.fromEntries(outside);
}

/**
 * Returns the manifest to publish: without sources and internal rooms. It has no dependencies: all but the peers is
 * bundled.
 */
function published() {
  const { private: _, devDependencies: __, dependencies: ___, exports, ...rest } = own;
  const { engines } = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));
  return {
    ...rest,
    engines,
    // The worker's modules answer messages; a bundler would drop the others' imports for side effects.
    sideEffects: ['./onnx-worker.js', './onnx/inference-worker.js'],
    exports: builtExports(exports),
  };
}

/**
 * The modules of the sources that read a file of the package or start a worker, the function of each, and the file or
 * the worker's module. Some bundlers drop files that code references by URL; a page would then stay with its fallback.
 */
const readers = [
  {
    module: 'bundled-weights',
    file: 'public/models/learned.bin',
    code: (bytes) => `export async function readBundledWeights(_stated, onProgress) {
      const read = await ${bytes};
      onProgress?.(1);
      return read;
    }`,
  },
  {
    module: 'bundled-mannequin',
    file: 'public/avatars/mannequin.vrm',
    code: (bytes) => `export const readBundledMannequin = async () => (await ${bytes}).buffer;`,
  },
  {
    module: 'bundled-validator',
    worker: 'src/threepoint/avatar/file/avatar-check-worker.ts',
    code: (bytes) => `let address;
    export async function startValidator() {
      address ??= URL.createObjectURL(new Blob([await ${bytes}], { type: 'text/javascript' }));
      return new Worker(address, { type: 'module' });
    }`,
  },
];
const embedded = (module) => `\0embedded-${module}`;

/** Embeds these files in JavaScript modules that load on demand. */
const filesInModules = {
  name: 'files-in-modules',
  resolveId: { filter: { id: /^\0embedded-/ }, handler: (id) => id },
  load: {
    filter: { id: /^\0embedded-|\/api\/bundled-\w+\.ts$/ },
    async handler(id) {
      const { module, file, worker, code } = readers.find((reader) => id.includes(reader.module));
      if (id === embedded(module)) {
        const bytes = worker ? await workerCode(worker) : readFileSync(join(root, file));
        return `export default ${JSON.stringify(bytes.toString('base64'))};`;
      }
      const bytes = `import(${JSON.stringify(embedded(module))}).then(({ default: text }) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0)))`;
      return { moduleType: 'js', code: code(bytes) };
    },
  },
};

/** Returns the code of a worker as one module. */
async function workerCode(module) {
  const build = await bundle({ worker: join(root, module) }, []);
  const { output } = await build.generate({ format: 'esm', minify: true, codeSplitting: false });
  await build.close();
  if (output.length !== 1) throw new SetupError(`The worker ${module} is ${output.length} files; it must be one.`);
  return Buffer.from(output[0].code);
}

/** Bundles the entries; `input` maps the name of each entry to its source file. */
async function bundle(input, plugins) {
  return rolldown({
    input,
    cwd: root,
    platform: 'browser',
    resolve: sourceResolution('browser'),
    external,
    plugins,
    tsconfig: join(root, 'tsconfig.json'),
    // In Node, gltf-validator would call `require`, which a module has not; it runs there as in a browser.
    transform: { define: { 'process.versions': 'undefined' } },
  });
}

/** Modules from outside the library's folder, by their names in the build: npm packs no folder node_modules. */
const movedModules = {
  '_virtual/_embedded-bundled-weights': 'learned-weights',
  '_virtual/_embedded-bundled-mannequin': 'mannequin',
  '_virtual/_embedded-bundled-validator': 'validator',
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
  const embedded = {
    name: 'embedded-files',
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
      plugins: [embedded],
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
  const build = await bundle(entries, [filesInModules]);
  await build.write({
    format: 'esm',
    dir: out,
    preserveModules: true,
    preserveModulesRoot: join(root, sourcesFolder),
    entryFileNames: ({ name }) => `${movedModules[name] ?? name}.js`,
    sourcemap: true,
    sourcemapPathTransform: (source, map) => sourceInPackage(join(dirname(map), source), map),
  });
  await build.close();
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
  const { code } = await run(process.execPath, ['node_modules/typescript/bin/tsc', '-p', config]);
  if (code !== 0) throw new SetupError(`The types of ${config} could not be written: exit code ${code}.`);
  for (const file of readdirSync(types, { recursive: true })) {
    const path = join(types, file);
    if (!file.endsWith('.d.ts')) continue;
    writeFileSync(
      path,
      readFileSync(path, 'utf8').replace(/(\b(?:from|import)\s*\(?\s*['"])(\.{1,2}\/[^'"]+?)(?=['"])/g, '$1$2.js'),
    );
  }
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
}

/** The entry of a page that draws its own avatars, as a bundler sees it. */
const trackerAlone = {
  name: 'tracker-alone',
  resolveId: { filter: { id: /^tracker-alone$/ }, handler: (id) => id },
  load: {
    filter: { id: /^tracker-alone$/ },
    handler: () => `export { BodyTracker } from ${JSON.stringify(join(out, 'three.js'))};`,
  },
};

/**
 * Returns the bytes of minified code with its static imports, plain and by brotli; without dynamic imports and peers.
 */
async function weigh(input, plugins = [filesInModules]) {
  const build = await bundle({ entry: input }, plugins);
  const { output: files } = await build.generate({ format: 'esm', minify: true });
  await build.close();
  const needed = new Set();
  const add = (file) => {
    if (needed.has(file)) return;
    needed.add(file);
    for (const imported of files.find(({ fileName }) => fileName === file)?.imports ?? []) add(imported);
  };
  add('entry.js');
  const code = files.filter(({ fileName }) => needed.has(fileName)).map((file) => Buffer.from(file.code));
  const size = (buffers) => buffers.reduce((sum, { length }) => sum + length, 0);
  return { min: size(code), brotli: size(code.map((buffer) => brotliCompressSync(buffer))) };
}

export const buildLibrary = () =>
  buildPackage('dist-library', async () => {
    rmSync(out, { recursive: true, force: true });
    await writeCode();
    await writeBundles();
    await writeTypes();
    writeFiles();
  });

/** The measured entries, by their names in the table of src/threepoint/README.md. */
async function measureSizes() {
  const sizes = {};
  for (const [name, source] of Object.entries(entries)) {
    const called = name === 'index' ? own.name : `${own.name}/${name}`;
    sizes[`\`${called}\``] = await weigh(source);
  }
  const weights = readFileSync(join(out, 'models/learned.bin'));
  sizes["the learned network's weights"] = { min: weights.length, brotli: brotliCompressSync(weights).length };
  return sizes;
}

/** Throws if src/threepoint/README.md or README.md states another size than the measured one. */
async function checkDocuments(sizes) {
  const rows = Object.entries(sizes).map(([what, { min, brotli }]) => ({
    what,
    says: new RegExp(`^\\| ${what} \\| ([\\d.]+) kB \\| ([\\d.]+) kB \\|$`, 'm'),
    bytes: [min, brotli],
  }));
  const alone = await weigh('tracker-alone', [trackerAlone]);
  const sentence = {
    what: 'threepoint/three, with and without loadAvatar',
    says: /(\d+) kB of code as it travels \((\d+) kB without `loadAvatar`\)/,
    bytes: [sizes['`threepoint/three`'].brotli, alone.brotli],
  };
  const stale = Object.entries({ 'src/threepoint/README.md': rows, 'README.md': [sentence] }).flatMap(
    ([file, claims]) => staleSizes(file, readFileSync(join(root, file), 'utf8'), claims),
  );
  if (stale.length > 0) throw new SetupError(`${stale.join('.\n')}.`);
}

function printSizes(sizes) {
  const kilobytes = (bytes) => `${(bytes / 1000).toFixed(1)} kB`.padStart(10);
  console.log(`${''.padEnd(32)}${'min'.padStart(10)}${'brotli'.padStart(10)}`);
  for (const [what, { min, brotli }] of Object.entries(sizes))
    console.log(`${what.padEnd(32)}${kilobytes(min)}${kilobytes(brotli)}`);
}

await mainOf(import.meta.url, async () => {
  await buildLibrary();
  const sizes = await measureSizes();
  printSizes(sizes);
  await checkDocuments(sizes);
});
