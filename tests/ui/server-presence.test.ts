import { readFileSync } from 'node:fs';
import type { RequestListener } from 'node:http';
import { expect, test } from 'vitest';
import { ServerPresence, type ServerState } from '../../src/ui/server-presence';
import { answeringHost, says } from '../rooms/client/answering-host';

/** A page from a host that answers so; `states` fills with what it learns of it. */
async function page(answer: RequestListener) {
  const { folder } = await answeringHost(answer);
  const states: ServerState[] = [];
  const presence = new ServerPresence(folder, () => states.push(presence.state));
  return { presence, states };
}

const ownAnswer = readFileSync(new URL('../../public/api/rooms', import.meta.url), 'utf8');

test.each([
  ['a server with no rooms open', 200, '{"rooms":[],"complete":true}', 'here'],
  ['a server that refuses this page', 403, '{"error":"this page may not use this server","field":null}', 'here'],
  ['a host of files', 404, '<h1>Not found</h1>', 'none'],
  ['a host of files with the page’s own answer', 200, ownAnswer, 'none'],
  ['a host that answers everything with the page', 200, '<!doctype html><title>threepoint</title>', 'none'],
  ['a proxy whose server is away', 502, '<h1>Bad gateway</h1>', 'silent'],
  ['a host that has been asked too often', 429, '', 'silent'],
] as const)('%s is taken for what it is', async (_, status, body, state) => {
  const { presence, states } = await page(says(status, body));
  expect(await presence.whenKnown()).toBe(state);
  expect(states).toEqual(['asked', state]);
});

test('it is asked once, below the folder of the page, however often its state is wanted', async () => {
  const paths: (string | undefined)[] = [];
  const { presence } = await page((request, response) => {
    paths.push(request.url);
    response.end('{"rooms":[]}');
  });
  await Promise.all([presence.whenKnown(), presence.whenKnown(), presence.refresh()]);
  await presence.whenKnown();
  expect(paths).toEqual(['/threepoint/api/rooms']);
});

test('one that was away is found when it is asked again', async () => {
  let away = true;
  const { presence } = await page((request, response) => {
    if (away) request.socket.destroy();
    else response.end('{"rooms":[]}');
  });
  expect(await presence.whenKnown()).toBe('silent');
  away = false;
  expect(await presence.whenKnown(), 'what is known is not asked for').toBe('silent');
  expect(await presence.refresh()).toBe('here');
});

test('one whose answer breaks off is silent: what came of it says nothing of the host', async () => {
  const { presence } = await page((request, response) => {
    response.writeHead(200, { 'content-type': 'application/json', 'content-length': 30 });
    response.write('{"rooms":', () => request.socket.destroy());
  });
  expect(await presence.whenKnown()).toBe('silent');
});
