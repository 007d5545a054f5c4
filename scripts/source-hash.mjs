// Which sources a built folder was made from, so that what is up to date is not built again.
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { dirname, join, relative, resolve } from 'node:path';
import { root } from './run-command.mjs';

export function filesUnder(path) {
  if (!existsSync(path)) return [];
  if (!statSync(path).isDirectory()) return [path];
  return readdirSync(path)
    .sort()
    .flatMap((name) => filesUnder(join(path, name)));
}

/** Returns the hash of these files and folders of the repository, and of the options of the build. */
export function sourceHash(sources, options = '') {
  const hash = createHash('sha256').update(options);
  for (const file of sources.flatMap((source) => filesUnder(resolve(root, source)))) {
    hash
      .update(`${relative(root, file)}\0`)
      .update(readFileSync(file))
      .update('\0');
  }
  return hash.digest('hex');
}

/** Whether this file holds this hash. */
export const isStamped = (stamp, hash) => existsSync(stamp) && readFileSync(stamp, 'utf8') === hash;

/** The paths that the built packages depend on. */
const packageSources = [
  ...['LICENSE', 'package.json', 'package-lock.json', 'docs/accuracy.md', 'public/models', 'public/avatars', 'src'],
  ...['tsconfig.json', 'tsconfig.library.json', 'tsconfig.packages.json', 'typedoc.json'],
  ...['scripts/build-library.mjs', 'scripts/build-packages.mjs', 'scripts/library', 'scripts/licences.mjs'],
];

const packageStamp = (folder) => join(root, 'artifacts', `${folder}.source-hash`);

/** Builds a package into its folder and records its sources, outside the folder: all files there are published. */
export async function buildPackage(folder, build) {
  const stamp = packageStamp(folder);
  const hash = sourceHash(packageSources);
  rmSync(stamp, { force: true });
  await build();
  mkdirSync(dirname(stamp), { recursive: true });
  writeFileSync(stamp, hash);
}

/** Whether a package was built from exactly these sources. */
export const isPackageCurrent = (folder) =>
  existsSync(join(root, folder, 'package.json')) && isStamped(packageStamp(folder), sourceHash(packageSources));
