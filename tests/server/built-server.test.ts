import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { unzipSync } from 'fflate';
import { expect, test } from 'vitest';
import { guestOfTest } from '../relay/until-finished';
import { reportFigures } from '../reliability/report-figures';
import { paperPlan } from '../study/model/studies';
import { ask } from './running-server';
import { forkServer } from './server-child';
import { experimenterToken } from './started-server';

test('the built server serves page, rooms and studies in their thread, and exports from a process', async () => {
  const { url } = await forkServer();
  expect(await (await fetch(url)).text()).toContain('<title>');
  await guestOfTest(url, 'meadow');
  const headers = { 'content-type': 'application/json', authorization: `Bearer ${experimenterToken}` };
  const plan = JSON.stringify({ plan: paperPlan(), simulated: true });
  expect((await fetch(`${url}/api/studies`, { method: 'POST', headers, body: plan })).status).toBe(201);
  const exported = await fetch(`${url}/api/studies/paper/export`, { headers });
  expect(exported.status).toBe(200);
  const files = Object.keys(unzipSync(new Uint8Array(await exported.arrayBuffer())));
  expect(files.some((file) => file.endsWith('results/answers-overall.csv'))).toBe(true);
});

test('the built server answers 400 to percent signs that encode no text, and lives on', async () => {
  const server = await forkServer();
  const paths = ['/%', '/%E0%A4%A', '/api/rooms/%', '/relay/%', '/api/studies/%/records', '/%ff.html'];
  for (const path of paths) {
    expect((await ask(server.url, path)).status, path).toBe(400);
  }
  expect(server.isAlive()).toBe(true);
  expect(server.errors()).toBe('');
  reportFigures('undecodable-paths', { 'paths refused': `${paths.length} of ${paths.length}`, 'processes ended': 0 });
});

test('the image gets the packages that the server imports, and none of the page', () => {
  const manifest = readFileSync(join(process.env.THREEPOINT_IMAGE as string, 'package.json'), 'utf8');
  const { dependencies } = JSON.parse(manifest);
  for (const name of ['socket.io', '@photostructure/sqlite']) expect(dependencies).toHaveProperty([name]);
  for (const name of ['three', 'onnxruntime-web', 'iwer', 'tsx']) expect(dependencies).not.toHaveProperty([name]);
});
