import { execFile } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { functionOfText } from 'threepoint/avatar/decoders/basis-functions';
import { inspectAvatar } from 'threepoint/avatar/file/inspect-avatar';
import { describe, expect, test } from 'vitest';
import { changed } from './glb';
import { type Colour, etc1sPicture, ktx2Picture, packedColours, zstdPicture } from './ktx2-picture';

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
async function transcoded(picture: Uint8Array, ...more: string[]) {
  const script = fileURLToPath(new URL('transcode-without-text.ts', import.meta.url));
  const flags = ['--disallow-code-generation-from-strings', '--import', 'tsx'];
  const { stdout } = await promisify(execFile)(process.execPath, [
    ...flags,
    script,
    Buffer.from(picture).toString('base64'),
    ...more,
  ]);
  return JSON.parse(stdout);
}

describe('the Basis transcoder where no text may be compiled', () => {
  test.each([
    { packed: 'UASTC', picture: ktx2Picture(colours), shown: colours, within: 0 },
    // Five bits a channel and one brightness for a block.
    { packed: 'ETC1S', picture: etc1sPicture, shown: packedColours, within: 12 },
    { packed: 'UASTC in Zstandard', picture: zstdPicture, shown: packedColours, within: 2 },
  ])(
    'unpacks a KTX2 picture ($packed) to its pixels, by functions made of values',
    async (packed) => {
      const { compiles, size, pixels, complaints } = await transcoded(packed.picture);
      const side = 4 * packed.shown.length;
      expect(compiles).toBe(false);
      expect(size).toEqual([side, side]);
      for (const [row, squares] of packed.shown.entries()) {
        for (const [column, colour] of squares.entries()) {
          for (const [x, y] of [
            [4 * column, 4 * row],
            [4 * column + 3, 4 * row + 3],
          ] as const) {
            const pixel: number[] = pixels.slice(4 * (side * y + x), 4 * (side * y + x) + 4);
            for (const [channel, value] of pixel.entries())
              expect(Math.abs(value - colour[channel]!), `${pixel} for ${colour}`).toBeLessThanOrEqual(packed.within);
          }
        }
      }
      expect(complaints[0]).toContain('deleted object');
      expect(complaints[1]).toContain('invalid number of parameters');
    },
    60_000,
  );

  test('does nothing as it is', async () => {
    expect(await transcoded(ktx2Picture(colours), '--as-it-is')).toMatchObject({
      error: expect.stringContaining('EvalError'),
    });
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
  test.each([
    ['UASTC', ktx2Picture(colours)],
    ['ETC1S', etc1sPicture],
    ['UASTC in Zstandard', zstdPicture],
  ])('passes as others do: %s', (_, picture) => {
    expect(() => look(picture)).not.toThrow();
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
