// node scripts/check-server.mjs ORIGIN TOKEN: checks a running server from outside: its page, its rooms, and a study
// that is stored and exported. TOKEN is the experimenter's.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { mainOf, root, SetupError } from './run-command.mjs';

/** Checks the server at this address; rejects with a SetupError that names the first request which failed. */
export async function checkServer(origin, token) {
  const ask = async (path, expected, request = {}) => {
    const headers = { authorization: `Bearer ${token}`, 'content-type': 'application/json' };
    const response = await fetch(`${origin}${path}`, { ...request, headers });
    const body = Buffer.from(await response.arrayBuffer());
    if (response.status !== expected)
      throw new SetupError(`${request.method ?? 'GET'} ${path}: ${response.status} instead of ${expected}\n${body}`);
    return body;
  };
  await ask('/healthz', 200);
  if (!`${await ask('/', 200)}`.includes('<title>')) throw new SetupError('GET /: the answer is no page.');
  await ask('/api/rooms', 200);
  const plan = JSON.parse(readFileSync(join(root, 'public/studies/paper.json'), 'utf8'));
  const id = `check-${Date.now()}`;
  const study = { plan: { ...plan, id }, simulated: true };
  await ask('/api/studies', 201, { method: 'POST', body: JSON.stringify(study) });
  const zip = await ask(`/api/studies/${id}/export`, 200);
  if (zip.toString('latin1', 0, 2) !== 'PK') throw new SetupError('The export of the study is no zip file.');
}

await mainOf(import.meta.url, async () => {
  const [origin, token] = process.argv.slice(2);
  if (!token) throw new SetupError('node scripts/check-server.mjs ORIGIN TOKEN');
  await checkServer(origin, token);
  console.log(`${origin} serves the page, rooms and studies.`);
});
