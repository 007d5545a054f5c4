import { existsSync } from 'node:fs';
import { join } from 'node:path';

/** Where a program of the distribution is; null: it is not installed. */
export function installed(name: string): string | null {
  const folders = [...(process.env.PATH ?? '').split(':'), '/usr/sbin', '/usr/local/sbin'];
  return folders.map((folder) => join(folder, name)).find(existsSync) ?? null;
}
