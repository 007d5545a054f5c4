import { existsSync, lstatSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root, run, SetupError } from './run-command.mjs';

const packagesIn = (file) => JSON.parse(readFileSync(file, 'utf8')).packages ?? {};

/**
 * Returns why node_modules does not match package-lock.json, or null if it does. npm lists what it installed in
 * node_modules/.package-lock.json and writes that file last, so an interrupted installation is detected too.
 */
export function missingInstallation(directory = root) {
  const installedFile = join(directory, 'node_modules/.package-lock.json');
  if (!existsSync(installedFile)) return 'nothing is installed yet';
  const installed = packagesIn(installedFile);
  for (const [path, wanted] of Object.entries(packagesIn(join(directory, 'package-lock.json')))) {
    // Skipped are the root itself, links, and optional packages that npm may omit on this platform.
    if (path === '' || wanted.link || wanted.optional || wanted.devOptional) continue;
    if (installed[path]?.version !== wanted.version) {
      return `${path.replace('node_modules/', '')} ${wanted.version} is missing`;
    }
  }
  return null;
}

/**
 * Installs the packages of package-lock.json if they are missing or outdated, but never into another clone's folder.
 */
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
