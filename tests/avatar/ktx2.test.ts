import { execFile } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { describe, expect, test } from 'vitest';
import { functionOfText } from '../../src/avatar/basis-functions';
import { inspectAvatar } from '../../src/avatar/inspect-avatar';
import { changed } from './glb';
import { type Colour, ktx2Picture } from './ktx2-picture';

const colours: readonly (readonly Colour[])[] = [
  [
    [255, 0, 0, 255],
    [0, 0, 255, 255],
  ],
  [
    [0, 200, 0, 255],
    [10, 20, 30, 128],
  ],
];

/** What the transcoder makes of the picture in a Node that compiles no text. */
async function transcoded(...more: string[]) {
  const script = fileURLToPath(new URL('transcode-without-text.ts', import.meta.url));
  const flags = ['--disallow-code-generation-from-strings', '--import', 'tsx'];
  const { stdout } = await promisify(execFile)(process.execPath, [...flags, script, JSON.stringify(colours), ...more]);
  return JSON.parse(stdout);
}

describe('the Basis transcoder where no text may be compiled', () => {
  test('unpacks a KTX2 picture to its pixels, by functions made of values', async () => {
    const { compiles, size, pixels, complaints } = await transcoded();
    expect(compiles).toBe(false);
    expect(size).toEqual([8, 8]);
    const at = (x: number, y: number) => pixels.slice(4 * (8 * y + x), 4 * (8 * y + x) + 4);
    for (const [row, squares] of colours.entries()) {
      for (const [column, colour] of squares.entries()) {
        expect(at(4 * column, 4 * row)).toEqual(colour);
        expect(at(4 * column + 3, 4 * row + 3)).toEqual(colour);
      }
    }
    expect(complaints[0]).toContain('deleted object');
    expect(complaints[1]).toContain('invalid number of parameters');
  }, 60_000);

  test('does nothing as it is', async () => {
    expect(await transcoded('--as-it-is')).toMatchObject({ error: expect.stringContaining('EvalError') });
  }, 60_000);

  test('asks for no other text than is known', () => {
    expect(() => functionOfText('a', 'b', 'return a + b')).toThrow(
      'the Basis transcoder wants a function of a text that is not known: return a + b',
    );
  });
});

/** The mannequin's file with a KTX2 picture. */
const withKtx2 = (picture: Uint8Array) =>
  changed((json, length) => {
    json.bufferViews.push({ buffer: 0, byteOffset: length, byteLength: picture.length });
    json.images = [{ bufferView: json.bufferViews.length - 1, mimeType: 'image/ktx2' }];
    json.buffers = [{ byteLength: length + picture.length }];
  }, picture);

/** The picture with another number in its header. */
function told(at: number, value: number): Uint8Array {
  const picture = ktx2Picture(colours);
  new DataView(picture.buffer).setUint32(at, value, true);
  return picture;
}

const look = (picture: Uint8Array) => inspectAvatar(new Uint8Array(withKtx2(picture)), 'person.vrm');

describe('a KTX2 picture in an avatar', () => {
  test('passes as others do', () => {
    expect(() => look(ktx2Picture(colours))).not.toThrow();
  });

  test.each([
    ['that says it is 16,384 pixels wide', told(20, 16_384), '16384 pixels across picture 0'],
    ['of a format that is not Basis', told(12, 37), 'picture 0, a KTX2, is no Basis picture'],
    ['of a thousand layers', told(32, 1000), 'picture 0, a KTX2, is no flat picture'],
    ['of six faces', told(36, 6), 'picture 0, a KTX2, is no flat picture'],
    ['of more levels than halvings', told(40, 30), 'picture 0, a KTX2, has 30 levels'],
    ['whose level unpacks to a gigabyte', told(96, 2 ** 30), 'picture 0, a KTX2, unpacks to more than its size'],
    ['whose level lies beyond its end', told(80, 10_000), 'picture 0, a KTX2, is cut short'],
    ['that ends in its header', ktx2Picture(colours).slice(0, 60), 'picture 0, a KTX2, is cut short'],
  ])('%s is refused before anything of it is unpacked', (_, picture, sentence) => {
    expect(() => look(picture)).toThrow(`person.vrm: ${sentence}`);
  });
});
