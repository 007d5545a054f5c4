import type { RequestListener } from 'node:http';
import { describe, expect, test } from 'vitest';
import { fileNameOf, readLimited } from '../../src/ui/limited-files';
import { reportFigures } from '../reliability/report-figures';
import { answeringHost } from '../rooms/client/answering-host';

const recording = { what: 'a recording', megabytes: 1 };

/** The address of a file that a server of this machine answers like this. */
async function servedAt(answer: RequestListener): Promise<string> {
  const { folder } = await answeringHost(answer);
  return `${folder}/walk.json?again`;
}

/** A file of this size whose bytes are counted as they are asked for. */
function dropped(size: number) {
  const file = new File(['{}'], 'walk.json');
  let reads = 0;
  Object.defineProperties(file, {
    size: { value: size },
    arrayBuffer: {
      value() {
        reads += 1;
        return new Blob(['{}']).arrayBuffer();
      },
    },
  });
  return { file, reads: () => reads };
}

describe('a file of this device', () => {
  test('is refused at 300 MB before a byte of it is read', async () => {
    const { file, reads } = dropped(300 * 2 ** 20);
    await expect(readLimited(file, { what: 'a recording', megabytes: 100 })).rejects.toThrow(
      'walk.json: larger than 100 MB, the limit for a recording',
    );
    expect(reads()).toBe(0);
    reportFigures('bad-input', { 'bytes read of 300 MB': 0 });
  });

  test('is read at its greatest allowed size', async () => {
    const { file, reads } = dropped(2 ** 20);
    expect((await readLimited(file, recording)).byteLength).toBe(2);
    expect(reads()).toBe(1);
  });
});

describe('the answer of an address', () => {
  test('comes whole, with the share that has come', async () => {
    const url = await servedAt((_, response) =>
      response.setHeader('content-length', 300_000).end(Buffer.alloc(300_000, 7)),
    );
    const shares: number[] = [];
    const bytes = await readLimited(url, recording, { onProgress: (share) => shares.push(share) });
    expect(new Uint8Array(bytes).every((byte) => byte === 7) && bytes.byteLength).toBe(300_000);
    expect(shares).toEqual([...shares].sort((a, b) => a - b));
    expect(shares.at(-1)).toBe(1);
  });

  test.each([
    ['nothing', 'walk.json: the server answers 404 Not Found', (_, response) => response.writeHead(404).end('no')],
    [
      'a web page',
      'walk.json: the server sent a web page instead of a recording',
      (_, response) => response.setHeader('content-type', 'text/html; charset=utf-8').end('<!doctype html>'),
    ],
    [
      'more than it may be, and says so',
      'walk.json: larger than 1 MB, the limit for a recording',
      (_, response) => response.setHeader('content-length', 300 * 2 ** 20).write('{'),
    ],
    [
      'half of what it promised',
      /^walk\.json: the connection was lost during the download \(/,
      (_, response) => {
        response.setHeader('content-length', 1000).write('{');
        setImmediate(() => response.destroy());
      },
    ],
  ] satisfies [string, string | RegExp, RequestListener][])(
    'is refused in a sentence: %s',
    async (_, sentence, answer) => {
      await expect(readLimited(await servedAt(answer), recording)).rejects.toThrow(sentence);
    },
  );

  test('is abandoned as soon as it is larger than it may be', async () => {
    let sent = 0;
    let ended = false;
    const url = await servedAt((_, response) => {
      const piece = Buffer.alloc(2 ** 16);
      const more = () => {
        while (!ended && response.write(piece)) sent += piece.length;
      };
      response.on('drain', more).on('close', () => {
        ended = true;
      });
      more();
    });
    await expect(readLimited(url, recording)).rejects.toThrow('larger than 1 MB');
    await expect.poll(() => ended).toBe(true);
    expect(sent).toBeLessThan(64 * 2 ** 20);
  });

  test('is a sentence where the server is missing', async () => {
    await expect(readLimited('http://127.0.0.1:9/walk.json', recording)).rejects.toThrow(
      /^walk\.json: could not be downloaded \(/,
    );
  });
});

test('a file is called by its name, an address by its last part', () => {
  expect(fileNameOf(new File([], 'a.vrm'))).toBe('a.vrm');
  expect(fileNameOf('https://elsewhere.test/bodies/b.vrm?x=1#y')).toBe('b.vrm');
  expect(fileNameOf('https://elsewhere.test/')).toBe('https://elsewhere.test/');
});
