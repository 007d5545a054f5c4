import { spawn, spawnSync } from 'node:child_process';
import { once } from 'node:events';
import { mkdirSync, readFileSync, renameSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { unzipSync } from 'fflate';
import { expect, onTestFinished, test } from 'vitest';
import { testSecret } from '../rooms/server/running-relay';
import { guestOfTest } from '../rooms/server/until-finished';
import { paperPlan } from '../study/model/studies';
import { directoryWith } from '../temporary-directory';
import { experimenterToken } from './server-child';

const root = fileURLToPath(new URL('../..', import.meta.url));

/** Runs the built server as the image does: without a loader, beside package.json, a page and packages. */
async function runBuiltServer(directory: string): Promise<string> {
  const built = spawnSync(
    process.execPath,
    [join(root, 'scripts/build-server.mjs'), '--out', join(directory, 'server')],
    {
      encoding: 'utf8',
    },
  );
  expect(built.status, built.stderr).toBe(0);
  renameSync(join(directory, 'server/package.json'), join(directory, 'package.json'));
  mkdirSync(join(directory, 'dist'));
  writeFileSync(join(directory, 'dist/index.html'), '<!doctype html><title>page</title>');
  symlinkSync(join(root, 'node_modules'), join(directory, 'node_modules'), 'junction');
  const child = spawn(process.execPath, ['--enable-source-maps', 'server/main.mjs'], {
    cwd: directory,
    env: {
      PATH: process.env.PATH,
      PORT: '0',
      STUDIES: join(directory, 'studies'),
      THREEPOINT_SECRET: testSecret,
      EXPERIMENTER_TOKEN: experimenterToken,
    },
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  onTestFinished(async () => {
    child.kill();
    if (child.exitCode === null) await once(child, 'exit');
  });
  const [welcome] = await once(child.stdout, 'data');
  const address = /http:\/\/localhost:\d+/.exec(String(welcome))?.[0];
  if (!address) throw new Error(`the built server names no address: ${welcome}`);
  return address;
}

test('the built server needs no loader: it serves the page, rooms, the studies from their thread, and exports from a process', {
  tags: ['full'],
}, async () => {
  const directory = directoryWith();
  const origin = await runBuiltServer(directory);
  expect(await (await fetch(origin)).text()).toContain('<title>page</title>');
  await guestOfTest(origin, 'meadow');
  const headers = { 'content-type': 'application/json', authorization: `Bearer ${experimenterToken}` };
  const plan = JSON.stringify({ plan: paperPlan(), simulated: true });
  expect((await fetch(`${origin}/api/studies`, { method: 'POST', headers, body: plan })).status).toBe(201);
  const exported = await fetch(`${origin}/api/studies/paper/export`, { headers });
  expect(exported.status).toBe(200);
  const files = Object.keys(unzipSync(new Uint8Array(await exported.arrayBuffer())));
  const { dependencies } = JSON.parse(readFileSync(join(directory, 'package.json'), 'utf8'));
  for (const name of ['socket.io', '@photostructure/sqlite']) expect(dependencies).toHaveProperty([name]);
  for (const name of ['three', 'onnxruntime-web', 'iwer']) expect(dependencies).not.toHaveProperty([name]);
  expect(files.some((file) => file.endsWith('results/answers-overall.csv'))).toBe(true);
});
