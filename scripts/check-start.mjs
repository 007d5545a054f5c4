// node scripts/check-start.mjs: runs `npm start` as a user does, checks what it serves, and ends it.
import { mkdtempSync, rmSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as pause } from 'node:timers/promises';
import { checkServer } from './check-server.mjs';
import { main, run, SetupError } from './run-command.mjs';

const token = 'check-Zk3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';

/** Returns a port of this machine that is free now. */
const freePort = () =>
  new Promise((resolve) => {
    const server = createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });

/** Resolves when the server answers, or the program has ended. */
async function answered(origin, ended) {
  for (;;) {
    const answer = await fetch(`${origin}/healthz`).catch(() => null);
    if (answer?.ok || ended.aborted) return;
    await pause(200);
  }
}

await main(async () => {
  const port = await freePort();
  const origin = `http://127.0.0.1:${port}`;
  const studies = mkdtempSync(join(tmpdir(), 'threepoint-start-'));
  const [ending, ended] = [new AbortController(), new AbortController()];
  const program = run('npm', ['start', '--', '--port', String(port), '--studies', studies], {
    env: { EXPERIMENTER_TOKEN: token },
    signal: ending.signal,
  }).finally(() => ended.abort());
  try {
    await answered(origin, ended.signal);
    if (ended.signal.aborted) throw new SetupError(`npm start ended with exit code ${(await program).code}.`);
    await checkServer(origin, token);
  } finally {
    ending.abort();
    await program;
    rmSync(studies, { recursive: true, maxRetries: 10 });
  }
  console.log('npm start serves the page, rooms and studies, and ends.');
});
