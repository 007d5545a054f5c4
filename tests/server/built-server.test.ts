import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { unzipSync } from 'fflate';
import { expect, test } from 'vitest';
import { reportFigures } from '../reliability/report-figures';
import { guestOfTest } from '../rooms/server/until-finished';
import { paperPlan } from '../study/model/studies';
import { directoryWith } from '../temporary-directory';
import { runBuiltServer } from './built-process';
import { ask } from './running-server';
import { experimenterToken } from './server-child';

test('the built server needs no loader: it serves the page, rooms, the studies from their thread, and exports from a process', {
  tags: ['full'],
}, async () => {
  const directory = directoryWith();
  const { origin } = await runBuiltServer(directory);
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
  expect(files.some((file) => file.endsWith('analysis/analyse.py'))).toBe(true);
});

test('the built server answers 400 to percent signs that encode no text, and lives on', {
  tags: ['full'],
}, async () => {
  const { origin, errors, isAlive } = await runBuiltServer(directoryWith());
  const paths = ['/%', '/%E0%A4%A', '/api/rooms/%', '/relay/%', '/api/studies/%/records', '/%ff.html'];
  for (const path of paths) {
    expect((await ask(origin, path)).status, path).toBe(400);
  }
  expect(isAlive()).toBe(true);
  expect(errors()).toBe('');
  reportFigures('undecodable-paths', { 'paths refused': `${paths.length} of ${paths.length}`, 'processes ended': 0 });
});
