import { join } from 'node:path';
import { createServer } from 'vite';
import { expect, onTestFinished, test, vi } from 'vitest';
import { root } from '../../scripts/run-command.mjs';
import { arrive, rawSocket, tokenFor, until } from '../relay/running-relay';
import { forkServer } from '../server/server-child';

/** Starts the server of `npm run dev` on a free port, in front of a relay of its own. Resolves to its origin. */
async function startDevelopment(): Promise<string> {
  const { port } = await forkServer();
  vi.stubEnv('PORT', String(port));
  const server = await createServer({
    root,
    configFile: join(root, 'vite.config.ts'),
    logLevel: 'error',
    server: { port: 0, watch: null },
    optimizeDeps: { noDiscovery: true },
  });
  onTestFinished(() => server.close());
  await server.listen();
  const [address] = server.resolvedUrls?.local ?? [];
  return new URL(address as string).origin;
}

test('npm run dev serves the page, and passes rooms with their WebSockets to the server', async () => {
  const origin = await startDevelopment();
  expect(await (await fetch(origin)).text()).toContain('src="/src/page/main.ts"');
  // public/api/rooms says to static hosts that there is no server.
  expect(await (await fetch(`${origin}/api/rooms`)).json()).toEqual({ rooms: [], complete: true });
  const people = ['Ann', 'Ben'].map((name) => arrive(origin, 'development', name));
  onTestFinished(() => {
    for (const person of people) person.stop();
  });
  await until('two people in one room', () =>
    people.every(({ connection }) => connection.room?.seats.filter(Boolean).length === 2),
  );
});

test('a page of the development server may use rooms and relay; other sites’ may not', { tags: ['full'] }, async () => {
  const server = await startDevelopment();
  for (const origin of [server, 'https://evil.example']) {
    const headers = { origin, 'content-type': 'application/json' };
    const body = JSON.stringify({ room: 'development', kind: 'ball' });
    const { status } = await fetch(`${server}/api/rooms/token`, { method: 'POST', headers, body });
    expect(status, origin).toBe(origin === server ? 200 : 403);
  }
  const token = await tokenFor(server, 'development');
  const outcomeFor = (from: string) => {
    const socket = rawSocket(server, token, 'development', { origin: from });
    onTestFinished(() => void socket.disconnect());
    return new Promise<string>((resolve) => {
      socket.on('connect', () => resolve('connected'));
      socket.on('connect_error', () => resolve('refused'));
    });
  };
  expect(await outcomeFor(server)).toBe('connected');
  expect(await outcomeFor('https://evil.example')).toBe('refused');
});
