import { existsSync, readFileSync } from 'node:fs';
import { connect } from 'node:net';
import { join } from 'node:path';
import { expect, test } from 'vitest';
import { run } from '../../scripts/run-command.mjs';
import { directoryWith } from '../temporary-directory';

const node = (script: string, options = {}) => run(process.execPath, ['-e', script], { capture: true, ...options });

function answers(port: number): Promise<boolean> {
  return new Promise((resolve) => {
    const socket = connect(port, '127.0.0.1');
    socket.once('connect', () => resolve(true)).once('error', () => resolve(false));
  });
}

test('a program that is run is ended with everything it started when its signal aborts', async () => {
  const portFile = join(directoryWith(), 'port');
  const listening = `
    const server = require('node:net').createServer().listen(0, '127.0.0.1', () =>
      require('node:fs').writeFileSync(${JSON.stringify(portFile)}, String(server.address().port)));`;
  const script = `
    require('node:child_process').spawn(process.execPath, ['-e', ${JSON.stringify(listening)}]);
    setInterval(() => {}, 1000);`;
  const ending = new AbortController();
  const running = node(script, { signal: ending.signal });
  await expect.poll(() => existsSync(portFile) && readFileSync(portFile, 'utf8') !== '').toBe(true);
  const port = Number(readFileSync(portFile, 'utf8'));
  expect(await answers(port)).toBe(true);
  ending.abort();
  expect((await running).code).not.toBe(0);
  await expect.poll(() => answers(port)).toBe(false);
});
