// Builds the published packages unless each was built from exactly these sources: “threepoint” by build-library.mjs,
// the others into dist-NAME/ as ESM with source maps and types. Bundled are their parts of packages of this repository,
// and no others. `npm pack ./dist-NAME` makes a tarball.
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, isAbsolute, join, posix } from 'node:path';
import { rolldown } from 'rolldown';
import {
  buildLibrary,
  changelogOf,
  documentInPackage,
  entriesOf,
  writeDeclarations,
  writeReference,
} from './build-library.mjs';
import { mainOf, root } from './run-command.mjs';
import { buildPackage, isPackageCurrent } from './source-hash.mjs';

/** Returns a package that `bundle` builds from src/NAME. `platform`: that of all its entries. */
const bundled = (name, platform) => ({ build: () => bundle(name, platform), folder: `dist-${name}` });

/** The published packages, and how each is built. */
export const packages = {
  threepoint: { build: buildLibrary, folder: 'dist-library' },
  'threepoint-rooms': bundled('rooms', 'browser'),
  'threepoint-relay': bundled('relay', 'node'),
};

/** Whether a module is from this repository, and no peer: a scene needs the one copy of what the library draws. */
const isOwn = (id) => isAbsolute(id) || (/^(\.|threepoint)/.test(id) && id !== 'threepoint/three');

async function writeCode(out, input, platform) {
  const build = await rolldown({
    input,
    cwd: root,
    platform,
    external: (id) => !isOwn(id),
    tsconfig: join(root, 'tsconfig.json'),
  });
  await build.write({ dir: out, format: 'esm', chunkFileNames: 'shared-[hash].js', sourcemap: true });
  await build.close();
}

/**
 * Returns the manifest to publish: without sources and internal modules. Peers of this repository may be of any version
 * that breaks nothing.
 */
function published({ private: _, devDependencies: __, publishConfig, dependencies, peerDependencies, ...rest }) {
  const imported = Object.entries(dependencies).filter(([name]) => !isOwn(name));
  const peers = Object.entries(peerDependencies).map(([name, range]) => [name, name in packages ? `^${range}` : range]);
  return {
    ...{ ...rest, ...publishConfig },
    dependencies: Object.fromEntries(imported),
    peerDependencies: Object.fromEntries(peers),
  };
}

/** The declarations of all packages, which the compiler writes at once: those of one import those of another. */
const declarations = join(root, 'artifacts/declarations');
let declared;

/** The manifests of the workspaces that packages are bundled from, by their names. */
const workspaces = Object.fromEntries(
  ['threepoint', 'rooms'].map((folder) => {
    const manifest = JSON.parse(readFileSync(join(root, 'src', folder, 'package.json'), 'utf8'));
    return [manifest.name, { folder, ...manifest }];
  }),
);

/** Returns the path of an unpublished entry's declarations; undefined: others install the module. */
function unpublishedEntry(module) {
  const [, name, entry] = /^(threepoint[^/]*)(\/.*)?$/.exec(module) ?? [];
  const { folder, exports, publishConfig } = workspaces[name] ?? {};
  const path = `.${entry ?? ''}`;
  if (!folder || path in publishConfig.exports) return undefined;
  return posix.join(folder, exports[path].replace(/ts$/, 'd.ts'));
}

/**
 * Copies the declarations of a package's entries into `out`/types with all that they name. Entries of this repository
 * that are not published are copied beside them.
 */
function copyDeclarations(name, out, entries) {
  const copied = new Set();
  const placeOf = (path) => (path.startsWith(`${name}/`) ? path.slice(name.length + 1) : path);
  const copy = (path) => {
    if (copied.has(path)) return;
    copied.add(path);
    const folder = posix.dirname(path);
    const text = readFileSync(join(declarations, path), 'utf8').replace(
      /(\b(?:from|import)\s*\(?\s*['"])([^'"]+)(?=['"])/g,
      (statement, before, module) => {
        const found = module.startsWith('.')
          ? posix.join(folder, module.replace(/js$/, 'd.ts'))
          : unpublishedEntry(module);
        if (found === undefined || !existsSync(join(declarations, found))) return statement;
        copy(found);
        const relative = posix.relative(posix.dirname(placeOf(path)), placeOf(found)).replace(/d\.ts$/, 'js');
        return `${before}${relative.startsWith('.') ? relative : `./${relative}`}`;
      },
    );
    const target = join(out, 'types', placeOf(path));
    mkdirSync(dirname(target), { recursive: true });
    writeFileSync(target, text);
  };
  for (const entry of entries) copy(posix.join(name, posix.relative('types', entry)));
}

function bundle(name, platform) {
  const out = join(root, `dist-${name}`);
  const source = `src/${name}`;
  return buildPackage(`dist-${name}`, async () => {
    const own = JSON.parse(readFileSync(join(root, source, 'package.json'), 'utf8'));
    rmSync(out, { recursive: true, force: true });
    mkdirSync(out);
    await writeCode(out, entriesOf(source, own), platform);
    declared ??= writeDeclarations('tsconfig.packages.json', declarations);
    await declared;
    const typed = Object.values(own.publishConfig.exports).flatMap(({ types }) => types ?? []);
    copyDeclarations(name, out, typed);
    await writeReference(out, Object.values(entriesOf(source, own)));
    copyFileSync(join(root, 'LICENSE'), join(out, 'LICENSE'));
    const documents = {
      ...{ 'README.md': `${source}/README.md`, 'CHANGELOG.md': changelogOf(source) },
      LICENSE: 'LICENSE',
    };
    for (const to of ['README.md', 'CHANGELOG.md']) {
      const text = readFileSync(join(root, documents[to]), 'utf8');
      writeFileSync(join(out, to), documentInPackage(text, to, documents));
    }
    writeFileSync(join(out, 'package.json'), `${JSON.stringify(published(own), null, 2)}\n`);
  });
}

export async function buildPackagesWhenStale(names = Object.keys(packages)) {
  for (const { build, folder } of names.map((name) => packages[name])) if (!isPackageCurrent(folder)) await build();
}

await mainOf(import.meta.url, () => buildPackagesWhenStale());
