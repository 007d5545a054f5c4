import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from './run-command.mjs';

/** Returns every package.json of the repository by its folder; '.' is the workspace itself. */
export function readManifests(directory = root) {
  const folders = ['.', 'server', ...readdirSync(join(directory, 'src')).map((name) => `src/${name}`)];
  const read = (folder) => JSON.parse(readFileSync(join(directory, folder, 'package.json'), 'utf8'));
  return Object.fromEntries(folders.map((folder) => [folder, read(folder)]));
}
