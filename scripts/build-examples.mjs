// Builds each of examples/ as its reader would: in an empty folder, with the packed package instead of the sources.
import { cpSync, mkdtempSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { buildLibrary } from './build-library.mjs';
import { main, root, runQuietly, SetupError } from './run-command.mjs';

async function done(command, args, cwd) {
  const result = await runQuietly(command, args, { cwd });
  if (result?.code !== 0) {
    throw new SetupError(
      `${command} ${args.join(' ')} failed in ${cwd}:\n${result?.output.trim() ?? 'it is not there'}`,
    );
  }
}

const quiet = ['--no-audit', '--no-fund', '--no-update-notifier', '--ignore-scripts'];

/** The names of the examples. */
export const exampleNames = readdirSync(join(root, 'examples'), { withFileTypes: true })
  .filter((file) => file.isDirectory())
  .map(({ name }) => name);

/**
 * Creates a folder outside the repository with the tarball, so that no import resolves to the repository's packages.
 */
export async function packLibrary() {
  await buildLibrary();
  const folder = mkdtempSync(join(tmpdir(), 'threepoint-examples-'));
  await done('npm', ['pack', join(root, 'dist-library'), '--pack-destination', folder], folder);
  return folder;
}

/** Installs and builds one example in the folder of the tarball; resolves to the folder of its built page. */
export async function buildExample(name, folder) {
  const [tarball] = readdirSync(folder).filter((file) => file.endsWith('.tgz'));
  const own = join(folder, name);
  cpSync(join(root, 'examples', name), own, { recursive: true });
  const manifest = JSON.parse(readFileSync(join(own, 'package.json'), 'utf8'));
  manifest.dependencies.threepoint = `file:../${tarball}`;
  writeFileSync(join(own, 'package.json'), JSON.stringify(manifest));
  await done('npm', ['install', ...quiet], own);
  await done(process.execPath, ['node_modules/vite/bin/vite.js', 'build', '--logLevel', 'error'], own);
  return join(own, 'dist');
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  await main(async () => {
    const folder = await packLibrary();
    for (const name of exampleNames) console.log(await buildExample(name, folder));
  });
}
