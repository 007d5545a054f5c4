import { existsSync } from 'node:fs';
import { delimiter, join } from 'node:path';

/**
 * Returns the path of a program of the distribution, by the first of its names that is found; null: it is not
 * installed, and its tests are left out. With THREEPOINT_PROGRAMS=required none may be left out: then a program that is
 * missing throws.
 */
export function installed(...names: string[]): string | null {
  const folders = [...(process.env.PATH ?? '').split(delimiter), '/usr/sbin', '/usr/local/sbin'];
  const found = names.flatMap((name) => folders.map((folder) => join(folder, name))).find(existsSync) ?? null;
  if (found === null && process.env.THREEPOINT_PROGRAMS === 'required')
    throw new Error(`${names[0]} is not installed, and THREEPOINT_PROGRAMS=required asks for every test`);
  return found;
}
