import { createHash } from 'node:crypto';
import type { RequestListener } from 'node:http';
import { type AvatarHash, TransientError } from 'threepoint/core';
import { expect, onTestFinished, test } from 'vitest';
import type { AvatarExchange } from '../../../src/rooms/client/avatar-exchange';
import { RoomAvatarLoader } from '../../../src/rooms/drawing/room-avatar-loader';
import { collectGarbage } from '../../collect-garbage.mjs';
import { answeringHost } from '../client/answering-host';

const hash = createHash('sha256').update('an avatar').digest('base64url') as AvatarHash;

/** The address of the file on a host that answers so. */
const answeredBy = async (answer: RequestListener): Promise<string> =>
  `${(await answeringHost(answer)).folder}/${hash}`;

/** An answer that begins and never ends. */
const neverEnding: RequestListener = (_request, response) => {
  response.writeHead(200, { 'content-type': 'model/gltf-binary' });
  response.write('glTF');
};

const unused = () => Promise.reject(new Error('not of this test'));

/** The exchange of a room whose files are at these addresses. */
const exchangeAt = (addressesOf: AvatarExchange['addressesOf']): AvatarExchange => ({
  terms: unused,
  isStoredElsewhere: unused,
  store: unused,
  addressesOf,
});

test('a file that never ends is abandoned with a sentence, and no next place is asked', async () => {
  const [first, second] = [await answeredBy(neverEnding), await answeredBy(neverEnding)];
  const asked: string[] = [];
  const exchange = exchangeAt(async () =>
    [first, second].map((url) => ({
      get url() {
        asked.push(url);
        return url;
      },
      headers: {},
    })),
  );
  const seen = new RoomAvatarLoader({ exchange, loadBuiltIn: unused, loadFile: unused, timeoutMs: 100 });
  // Node forgets a timeout that nothing refers to (nodejs/node#57736): the collector must not end the patience.
  const collecting = setInterval(collectGarbage, 20);
  onTestFinished(() => clearInterval(collecting));
  await expect(seen.load(hash)).rejects.toThrow('it did not arrive in time');
  expect(asked).toEqual([first]);
});

/** Loads from the store of a room that has the file at this address. */
const from = (url: string) => {
  const exchange = exchangeAt(async () => [{ url, headers: {} }]);
  return new RoomAvatarLoader({ exchange, loadBuiltIn: unused, loadFile: unused });
};

test.each<[what: string, answer: RequestListener, passes: boolean]>([
  ['a file that is not there yet', (_, response) => response.writeHead(404).end(), true],
  ['a connection that is lost', ({ socket }) => socket.destroy(), true],
  [
    'a file that is too large',
    (_, response) => response.writeHead(200, { 'content-length': String(2 ** 30) }).flushHeaders(),
    false,
  ],
])('%s is said to be a fault that passes, or not', async (_, answer, passes) => {
  const fault = await from(await answeredBy(answer))
    .load(hash)
    .catch((error: unknown) => error);
  expect(fault).toBeInstanceOf(Error);
  expect(fault instanceof TransientError).toBe(passes);
});

test('another file than the announced one is refused before it is read', async () => {
  const seen = from(await answeredBy((_, response) => response.end('another avatar')));
  await expect(seen.load(hash)).rejects.toThrow('the server sent a different file than the player announced');
});
