import { type ChildProcess, spawn, spawnSync } from 'node:child_process';
import { once } from 'node:events';
import { mkdirSync, renameSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { expect, onTestFinished } from 'vitest';
import { testSecret } from '../rooms/server/running-relay';
import { isAlive, kill } from './child-process';
import { experimenterToken } from './server-child';

const root = fileURLToPath(new URL('../..', import.meta.url));

/**
 * Builds the server into a folder as the image does, next to package.json, a page and packages; it needs no loader.
 */
export function buildServer(directory: string): void {
  const built = spawnSync(
    process.execPath,
    [join(root, 'scripts/build-server.mjs'), '--out', join(directory, 'server')],
    { encoding: 'utf8' },
  );
  expect(built.status, built.stderr).toBe(0);
  renameSync(join(directory, 'server/package.json'), join(directory, 'package.json'));
  mkdirSync(join(directory, 'dist'));
  writeFileSync(join(directory, 'dist/index.html'), '<!doctype html><title>page</title>');
  symlinkSync(join(root, 'node_modules'), join(directory, 'node_modules'), 'junction');
}

/** The built server in a process of its own, until the test is over. */
export interface BuiltServer {
  /** The address of the page on this machine. */
  readonly origin: string;
  readonly port: number;
  isAlive(): boolean;
  /** Returns what the process has written to its error stream: its log. */
  errors(): string;
}

/** Builds and runs the server; `words` are the arguments of its command line. */
export async function runBuiltServer(directory: string, words: readonly string[] = []): Promise<BuiltServer> {
  buildServer(directory);
  const child: ChildProcess = spawn(process.execPath, ['--enable-source-maps', 'server/main.mjs', ...words], {
    cwd: directory,
    env: {
      PATH: process.env.PATH,
      PORT: '0',
      STUDIES: join(directory, 'studies'),
      THREEPOINT_SECRET: testSecret,
      THREEPOINT_LOG_LEVEL: 'silent',
      EXPERIMENTER_TOKEN: experimenterToken,
    },
    stdio: ['ignore', 'pipe', 'pipe'],
  });
  onTestFinished(() => kill(child));
  let errors = '';
  child.stderr?.on('data', (text: Buffer) => {
    errors += text;
  });
  const [welcome] = await once(child.stdout as NodeJS.ReadableStream, 'data');
  const address = /(https?:\/\/localhost):(\d+)/.exec(String(welcome));
  if (!address) throw new Error(`the built server names no address: ${welcome} ${errors}`);
  return { origin: address[0], port: Number(address[2]), isAlive: () => isAlive(child), errors: () => errors };
}
