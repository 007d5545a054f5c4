// Builds each of examples/ as its reader would: in an empty folder, with the packed packages instead of the sources.
// With --out DIR, those that need no server of their own are built for a host of files, each in a folder of DIR.
import { cpSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { buildPackagesWhenStale, packages } from './build-packages.mjs';
import { mainOf, outputOf, root } from './run-command.mjs';

// Playwright sets NODE_ENV to "test", with which Next cannot build.
const npm = (args, cwd) =>
  outputOf('npm', args, `npm ${args.join(' ')} failed in ${cwd}`, { cwd, env: { NODE_ENV: undefined } });

const quiet = ['--no-audit', '--no-fund', '--no-update-notifier', '--ignore-scripts', '--prefer-offline'];

const manifestOf = (name) => JSON.parse(readFileSync(join(root, 'examples', name, 'package.json'), 'utf8'));

const allNames = readdirSync(join(root, 'examples'), { withFileTypes: true })
  .filter((file) => file.isDirectory())
  .map(({ name }) => name);

const hasRooms = (name) => 'threepoint-rooms' in manifestOf(name).dependencies;

/** The names of the examples that draw other people's bodies. */
export const roomExampleNames = allNames.filter(hasRooms);

/** The names of the examples of the wearer's own body. */
export const exampleNames = allNames.filter((name) => !hasRooms(name));

/**
 * Creates a folder outside the repository with the packages' tarballs, each in a folder of the package's name. There no
 * import resolves to the repository's packages.
 */
export async function pack(names = Object.keys(packages)) {
  const folder = mkdtempSync(join(tmpdir(), 'threepoint-examples-'));
  await buildPackagesWhenStale(names);
  for (const name of names) {
    mkdirSync(join(folder, name));
    await npm(['pack', join(root, packages[name].folder), '--pack-destination', join(folder, name)], folder);
  }
  return folder;
}

/**
 * Installs and builds one example in the folder of the tarballs, with each of its scripts for a build. Resolves to its
 * folder, which is the page where the example needs no build. `versions`: of dependencies, in place of the example's.
 */
export async function buildExample(name, folder, versions = {}) {
  const own = mkdtempSync(join(folder, `example-${name}-`));
  cpSync(join(root, 'examples', name), own, { recursive: true });
  const manifest = manifestOf(name);
  Object.assign(manifest.dependencies, versions);
  for (const packed of Object.keys(packages).filter((packed) => packed in manifest.dependencies)) {
    const [tarball] = readdirSync(join(folder, packed));
    manifest.dependencies[packed] = `file:../${packed}/${tarball}`;
  }
  writeFileSync(join(own, 'package.json'), JSON.stringify(manifest));
  await npm(['install', ...quiet], own);
  for (const [script, command] of Object.entries(manifest.scripts ?? {}).filter(([script]) =>
    script.startsWith('build'),
  )) {
    // The page runs from any folder.
    const options = command === 'vite build' ? ['--', '--base', './', '--logLevel', 'error'] : [];
    await npm(['run', script, ...options], own);
  }
  return own;
}

/** Whether an example is pages alone, which a bundler builds. */
function isStatic(name) {
  const { scripts = {} } = manifestOf(name);
  return scripts.build !== undefined && scripts.start === undefined;
}

/** Builds the examples for a host of files into a folder, with a page that lists them. */
async function buildStatic(out) {
  const folder = await pack();
  const names = allNames.filter(isStatic);
  for (const name of names)
    cpSync(join(await buildExample(name, folder), 'dist'), join(out, name), { recursive: true });
  const links = names.map((name) => `<li><a href="./${name}/">${name}</a></li>`).join('');
  const title = 'threepoint: examples';
  writeFileSync(
    join(out, 'index.html'),
    `<!doctype html><html lang="en"><meta charset="utf-8"><title>${title}</title><h1>${title}</h1><ul>${links}</ul></html>\n`,
  );
  rmSync(folder, { recursive: true });
}

await mainOf(import.meta.url, async () => {
  const { out } = parseArgs({ options: { out: { type: 'string' } } }).values;
  if (out !== undefined) return buildStatic(resolve(root, out));
  const folder = await pack();
  for (const name of allNames) console.log(await buildExample(name, folder));
  return 0;
});
