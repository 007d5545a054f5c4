import { existsSync, lstatSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root, run, SetupError } from './run-command.mjs';

const packagesIn = (file) => JSON.parse(readFileSync(file, 'utf8')).packages ?? {};

/**
 * Why node_modules does not hold what package-lock.json asks for, or null when it does. npm notes what it installed in
 * node_modules/.package-lock.json, and writes that file last, so an installation that was cut short shows too.
 */
export function missingInstallation(directory = root) {
  const installedFile = join(directory, 'node_modules/.package-lock.json');
  if (!existsSync(installedFile)) return 'nothing is installed yet';
  const installed = packagesIn(installedFile);
  for (const [path, wanted] of Object.entries(packagesIn(join(directory, 'package-lock.json')))) {
    // The root itself, links, and what npm may leave out on this platform.
    if (path === '' || wanted.link || wanted.optional || wanted.devOptional) continue;
    if (installed[path]?.version !== wanted.version) {
      return `${path.replace('node_modules/', '')} ${wanted.version} is missing`;
    }
  }
  return null;
}

/** Installs the packages of package-lock.json where they are missing or older; never into a folder that belongs to another copy. */
export async function ensureInstalled(directory = root) {
  const reason = missingInstallation(directory);
  if (reason === null) return;
  if (lstatSync(join(directory, 'node_modules'), { throwIfNoEntry: false })?.isSymbolicLink()) {
    throw new SetupError(
      `${reason}, and node_modules is a symbolic link: npm ci would empty the folder it leads to. Install the packages there, or remove the link.`,
    );
  }
  console.log(`Installing packages (${reason}) ...`);
  const { code } = await run('npm', ['ci', '--include=dev', '--no-audit', '--no-fund', '--no-update-notifier'], {
    cwd: directory,
  });
  if (code !== 0) {
    throw new SetupError(
      `npm ci failed with exit code ${code}; its messages are above. It needs the npm registry once (npm config get registry).`,
    );
  }
}
