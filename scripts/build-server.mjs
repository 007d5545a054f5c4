// Builds the server into JavaScript, for machines without the tools that run it from its sources: node
// dist-server/main.mjs. Its dependencies are not bundled (npm ci --omit=dev). npm run build builds the page.
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { rolldown } from 'rolldown';
import { installedFolders, writeLicences } from './licences.mjs';
import { mainOf, root, SetupError } from './run-command.mjs';

/** The default output folder, next to server/: the server reads ../package.json, ../dist/ and ../study-data/. */
const usualOut = 'dist-server';
const worker = '-worker.mjs';

/**
 * Returns the entries of the server, its threads and its child processes by name. From source these begin with
 * NAME-worker.mjs, which loads NAME-work.ts with a loader for TypeScript; in the build NAME-worker.mjs is NAME-work.ts.
 */
function entries() {
  const workers = ['server', 'src/study/server/export'].flatMap((folder) =>
    readdirSync(join(root, folder)).flatMap((file) => (file.endsWith(worker) ? [`${folder}/${file}`] : [])),
  );
  return Object.fromEntries([
    ['main', join(root, 'server/main.ts')],
    ...workers.map((file) => {
      const work = file.replace(worker, '-work.ts');
      if (!existsSync(join(root, work))) throw new SetupError(`${file} needs a ${work} to load.`);
      return [basename(file, '.mjs'), join(root, work)];
    }),
  ]);
}

/** The packages whose code is part of the server. */
const packages = ['server', ...['games', 'http', 'relay', 'rooms', 'study', 'threepoint'].map((name) => `src/${name}`)];
const manifestIn = (folder) => JSON.parse(readFileSync(join(root, folder, 'package.json'), 'utf8'));

/**
 * Bundles the server's own files into `out`; packages and Node's modules are imported at run time. The written
 * package.json names those packages alone, so that npm prune removes the page's packages. Writes their licences, too.
 * `plugins`: of Rolldown.
 */
export async function buildServer(out, plugins = []) {
  const { version, type } = manifestIn('.');
  const manifests = packages.map(manifestIn);
  const dependencies = Object.assign({}, ...manifests.map((manifest) => manifest.dependencies));
  for (const { name } of manifests) delete dependencies[name];
  const packageOf = (id) => Object.keys(dependencies).find((known) => id === known || id.startsWith(`${known}/`));
  const bundle = await rolldown({
    input: entries(),
    plugins,
    cwd: root,
    platform: 'node',
    external: (id) => id.startsWith('node:') || packageOf(id) !== undefined,
    tsconfig: join(root, 'tsconfig.json'),
  });
  rmSync(out, { recursive: true, force: true });
  mkdirSync(out, { recursive: true });
  const { output } = await bundle.write({
    dir: out,
    format: 'es',
    sourcemap: true,
    entryFileNames: '[name].mjs',
    chunkFileNames: '[name].mjs',
  });
  await bundle.close();
  const foreign = output.flatMap(({ moduleIds = [] }) => moduleIds).filter((id) => id.includes('node_modules'));
  if (foreign.length > 0) {
    throw new SetupError(`The server imports packages that no package.json names: ${foreign.join(', ')}`);
  }
  const imported = new Set(
    output.flatMap(({ imports = [], dynamicImports = [] }) => [...imports, ...dynamicImports]).map(packageOf),
  );
  const own = Object.fromEntries(Object.entries(dependencies).filter(([known]) => imported.has(known)));
  const manifest = { name: 'threepoint-server', version, type, private: true, dependencies: own };
  writeFileSync(join(out, 'package.json'), `${JSON.stringify(manifest, null, 2)}\n`);
  writeLicences(out, installedFolders(Object.keys(own)));
}

await mainOf(import.meta.url, () => {
  const { values } = parseArgs({ options: { out: { type: 'string', default: usualOut } } });
  return buildServer(resolve(root, values.out));
});
