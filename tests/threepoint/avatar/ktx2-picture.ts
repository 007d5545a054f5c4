// reason: three.js ships ktx-parse without types.
// @ts-expect-error
import { createDefaultContainer, KHR_DF_MODEL_UASTC, write } from 'three/examples/jsm/libs/ktx-parse.module.js';

export type Colour = readonly [red: number, green: number, blue: number, alpha: number];

/** UASTC's block of one colour: mode 8 in 5 bits, then 8 bits a channel, lowest first; hints for ETC1 stay 0. */
function blockOf([red, green, blue, alpha]: Colour): Uint8Array {
  const bits = 0x17n | (BigInt(red) << 5n) | (BigInt(green) << 13n) | (BigInt(blue) << 21n) | (BigInt(alpha) << 29n);
  return Uint8Array.from({ length: 16 }, (_, byte) => Number((bits >> BigInt(8 * byte)) & 0xffn));
}

/** A KTX2 picture (UASTC, sRGB) of squares of four pixels, row by row. */
export function ktx2Picture(rows: readonly (readonly Colour[])[]): Uint8Array<ArrayBuffer> {
  const container = createDefaultContainer();
  container.pixelWidth = 4 * rows[0]!.length;
  container.pixelHeight = 4 * rows.length;
  container.typeSize = 1;
  container.levelCount = 1;
  const levelData = Buffer.concat(rows.flatMap((row) => row.map(blockOf)));
  container.levels = [{ levelData, uncompressedByteLength: levelData.length }];
  const [descriptor] = container.dataFormatDescriptor;
  descriptor.colorModel = KHR_DF_MODEL_UASTC;
  descriptor.transferFunction = 2;
  descriptor.texelBlockDimension = [3, 3, 0, 0];
  descriptor.bytesPlane = [16, 0, 0, 0, 0, 0, 0, 0];
  descriptor.samples = [
    {
      bitOffset: 0,
      bitLength: 127,
      channelType: 3,
      samplePosition: [0, 0, 0, 0],
      sampleLower: 0,
      sampleUpper: 0xffffffff,
    },
  ];
  return new Uint8Array(write(container));
}

const magenta: Colour = [255, 0, 255, 255];
const blue: Colour = [0, 0, 255, 255];

/** What the packed pictures below show, in squares of four pixels. */
export const packedColours: readonly (readonly Colour[])[] = [
  [magenta, blue, magenta],
  [
    [0, 200, 0, 255],
    [128, 128, 128, 255],
    [255, 255, 0, 255],
  ],
  [magenta, blue, magenta],
];

const ofText = (lines: readonly string[]) => new Uint8Array(Buffer.from(lines.join(''), 'base64'));

/**
 * These colours packed by Basis Universal's encoder, which the project's own code cannot do: ETC1S, whose blocks share
 * codebooks (BasisLZ).
 */
export const etc1sPicture = ofText([
  'q0tUWCAyMLsNChoKAAAAAAEAAAAMAAAADAAAAAAAAAAAAAAAAQAAAAEAAAABAAAAaAAAACwAAACUAAAAJAAAALgAAAAAAAAAkQAAAAAAAABJAQ',
  'AAAAAAAAMAAAAAAAAAAAAAAAAAAAAsAAAAAAAAAAIAKACjAQIAAwMAAAgAAAAAAAAAAAA/AAAAAAAAAAAA/////x8AAABLVFh3cml0ZXIAQmFz',
  'aXMgVW5pdmVyc2FsIDIuNTAAAAUAAgAxAAAACQAAAC8AAAAAAAAAAAAAAAAAAAADAAAAAAAAAAAAAAAgQJQAAAAAAIgHskQCmBAAAAAAAIEmyA',
  'UwIQAAAAAAAukEBGAKAAAAAAAEygKZEu4MrKqqqlJVVVUFAMFEAAAAAAAA8l+tAJgAIAAAAACBWoaACQECAAAAIIiuNEUBYAIAAAAAAAABCAA4',
  'ZDE=',
]);

/** These colours as UASTC in a frame of Zstandard. */
export const zstdPicture = ofText([
  'q0tUWCAyMLsNChoKAAAAAAEAAAAMAAAADAAAAAAAAAAAAAAAAQAAAAEAAAACAAAAaAAAACwAAACUAAAAJAAAAAAAAAAAAAAAAAAAAAAAAAC4AA',
  'AAAAAAAEAAAAAAAAAAkAAAAAAAAAAsAAAAAAAAAAIAKACmAQIAAwMAABAAAAAAAAAAAAB/AAAAAAAAAAAA/////x8AAABLVFh3cml0ZXIAQmFz',
  'aXMgVW5pdmVyc2FsIDIuNTAAACi1L/0gkL0BADQC9x/g/x984AEAFwDg/x8CGeD/Ax4AFxAQ8B9ACPf/H+AffA8HAI0hAlAMKAYQNZQHM3fJwB',
  'E=',
]);
