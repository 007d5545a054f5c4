import { closeSync, existsSync, openSync } from 'node:fs';

/**
 * Creates an empty file that only the server's account can read, unless it exists. SQLite gives the files next to it
 * the same mode.
 */
export function createPrivateFile(file: string): void {
  if (!existsSync(file)) closeSync(openSync(file, 'a', 0o600));
}
