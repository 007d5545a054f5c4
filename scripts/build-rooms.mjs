// Builds the package “threepoint-rooms” into dist-rooms/: ESM with source maps and types. Its parts of the library that
// the library does not export are bundled. `npm pack ./dist-rooms` makes the tarball.
import { copyFileSync, mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { rolldown } from 'rolldown';
import { builtExports, documentInPackage, writeDeclarations } from './build-library.mjs';
import { mainOf, root } from './run-command.mjs';
import { sourceResolution } from './source-condition.mjs';
import { buildPackage } from './source-hash.mjs';

const out = join(root, 'dist-rooms');
/** The entries and their modules, by the platform that they are for. */
const entries = {
  browser: { index: 'index', room: 'room', socket: 'socket', three: 'drawing/index', react: 'react/index' },
  node: { server: 'server/index' },
};
const own = JSON.parse(readFileSync(join(root, 'src/rooms/package.json'), 'utf8'));

/** The documents of the package: path in the package to path in the repository. */
const documents = { 'README.md': 'src/rooms/README.md', LICENSE: 'LICENSE' };

/** What the package imports at run time; the rest is bundled. */
const bundled = ['threepoint', 'threepoint-http', 'valibot'];
const imported = [...Object.keys(own.dependencies), ...Object.keys(own.peerDependencies)].filter(
  (name) => !bundled.includes(name),
);
const external = (id) =>
  id.startsWith('node:') ||
  id === 'threepoint/three' ||
  imported.some((name) => id === name || id.startsWith(`${name}/`));

async function writeCode(platform, modules) {
  const build = await rolldown({
    input: Object.fromEntries(
      Object.entries(modules).map(([name, module]) => [name, join(root, `src/rooms/${module}.ts`)]),
    ),
    cwd: root,
    platform,
    resolve: sourceResolution(platform),
    external,
    tsconfig: join(root, 'tsconfig.json'),
  });
  await build.write({ dir: out, format: 'esm', chunkFileNames: 'shared-[hash].js', sourcemap: true });
  await build.close();
}

/** Keeps the declarations of this package: those of the library come with it. */
async function writeTypes() {
  const types = join(out, 'types');
  await writeDeclarations('tsconfig.rooms.json', types);
  renameSync(join(types, 'rooms'), join(out, 'rooms'));
  rmSync(types, { recursive: true });
  renameSync(join(out, 'rooms'), types);
}

/** Returns the manifest to publish: without sources and internal modules. */
function published() {
  const { private: _, devDependencies: __, exports, dependencies, ...rest } = own;
  return {
    ...rest,
    sideEffects: false,
    exports: { ...builtExports(exports), './package.json': './package.json' },
    dependencies: Object.fromEntries(Object.entries(dependencies).filter(([name]) => !bundled.includes(name))),
  };
}

export const buildRooms = () =>
  buildPackage('dist-rooms', async () => {
    rmSync(out, { recursive: true, force: true });
    mkdirSync(out);
    for (const [platform, modules] of Object.entries(entries)) await writeCode(platform, modules);
    await writeTypes();
    copyFileSync(join(root, documents.LICENSE), join(out, 'LICENSE'));
    const readme = readFileSync(join(root, documents['README.md']), 'utf8');
    writeFileSync(join(out, 'README.md'), documentInPackage(readme, 'README.md', documents));
    writeFileSync(join(out, 'package.json'), `${JSON.stringify(published(), null, 2)}\n`);
  });

await mainOf(import.meta.url, buildRooms);
