import { createHash } from 'node:crypto';
import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import { expect, onTestFinished, test } from 'vitest';
import { SeenAvatars } from '../../../src/app/ball/seen-avatars';
import type { AvatarHash } from '../../../src/core/protocol/worn-avatar';
import { collectGarbage } from '../../collect-garbage';

const hash = createHash('sha256').update('an avatar').digest('base64url') as AvatarHash;

/** A server that begins an answer and never ends it. */
async function neverEnding(): Promise<string> {
  const server = createServer((_request, response) => {
    response.writeHead(200, { 'content-type': 'model/gltf-binary' });
    response.write('glTF');
  });
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  onTestFinished(() => {
    server.closeAllConnections();
    server.close();
  });
  return `http://127.0.0.1:${(server.address() as AddressInfo).port}/${hash}`;
}

const unused = () => Promise.reject(new Error('not of this test'));

test('a file that never ends is given up with a sentence, and the next place is not asked', async () => {
  const [first, second] = [await neverEnding(), await neverEnding()];
  const asked: string[] = [];
  const seen = new SeenAvatars(
    new ArrayBuffer(0),
    unused,
    {
      ...{ terms: unused, liesElsewhere: unused, store: unused },
      addressesOf: async () =>
        [first, second].map((url) => ({
          get url() {
            asked.push(url);
            return url;
          },
          headers: {},
        })),
    },
    { patienceMs: 100 },
  );
  // Node forgets a timeout that nothing refers to (nodejs/node#57736): the collector must not end the patience.
  const collecting = setInterval(collectGarbage, 20);
  onTestFinished(() => clearInterval(collecting));
  await expect(seen.load(hash)).rejects.toThrow('it did not arrive in time');
  expect(asked).toEqual([first]);
});
