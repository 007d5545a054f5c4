import { readFileSync } from 'node:fs';
import { inflateSync } from 'node:zlib';
import { describe, expect, test } from 'vitest';
import { layOutLightMap, mapWidth, type Patch } from '../../../src/page/studio/room/light-map';
import { sides, towardsSun } from '../../../src/page/studio/room/room-plan';
import { bakeLight } from '../../../tools/studio/bake-light';
import { writePng } from '../../../tools/studio/png';

const file = readFileSync(new URL('../../../src/page/studio/room/light-map.png', import.meta.url));

/** Returns the rows of a PNG that `writePng` wrote, still filtered. */
function filteredRows(png: Buffer): { readonly width: number; readonly height: number; readonly rows: Buffer } {
  const length = png.readUInt32BE(33);
  expect(png.toString('latin1', 37, 41)).toBe('IDAT');
  return {
    width: png.readUInt32BE(16),
    height: png.readUInt32BE(20),
    rows: inflateSync(png.subarray(41, 41 + length)),
  };
}

/** Returns the green of a texel of the map, 0 to 255. */
function createReader() {
  const { width, height, rows } = filteredRows(file);
  const stride = 3 * width + 1;
  const green = new Uint8Array(width * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const left = x === 0 ? 0 : green[y * width + x - 1]!;
      const above = y === 0 ? 0 : green[(y - 1) * width + x]!;
      green[y * width + x] = rows[y * stride + 1 + 3 * x + 1]! + ((left + above) >> 1);
    }
  }
  return (x: number, y: number) => green[Math.round(y) * width + Math.round(x)]!;
}

const { patches, mapHeight } = layOutLightMap();
const patchOf = (name: string) => patches.find(({ side }) => side?.name === name)!;

/** Returns the green of the map at a point of a side of the room, floor frame [m]. */
function lightAt(patch: Patch, at: readonly [number, number, number]): number {
  const share = (edge: Patch['u']) =>
    edge.reduce((sum, value, i) => sum + (at[i]! - patch.origin[i]!) * value, 0) /
    edge.reduce((sum, v) => sum + v * v, 0);
  return createReader()(patch.x + share(patch.u) * (patch.columns - 1), patch.y + share(patch.v) * (patch.rows - 1));
}

describe('the light map of the studio', () => {
  test('has the size that the room needs, and no two patches share a texel', () => {
    const { width, height } = filteredRows(file);
    expect([width, height]).toEqual([mapWidth, mapHeight]);
    const taken = new Uint8Array(width * height);
    for (const { x, y, columns, rows } of patches)
      for (let i = 0; i < columns * rows; i++) taken[(y + Math.floor(i / columns)) * width + x + (i % columns)]! += 1;
    expect(Math.max(...taken)).toBe(1);
  });

  test('has the sun where its rays come through the windows, and shadow beside them', () => {
    const [floor, right] = [patchOf('floor'), patchOf('right')];
    const behind = (from: readonly [number, number, number], axis: number, to: number) =>
      from.map((value, i) => value - ((from[axis]! - to) / towardsSun[axis]!) * towardsSun[i]!) as never;
    for (const { openings } of sides.filter(({ name }) => name === 'left')) {
      for (const { from, to } of openings) {
        // A quarter along: the bars are in the middle.
        const pane = [from[0], 1.46, from[2] + 0.25 * (to[2] - from[2])] as const;
        const beside = [from[0], 1.46, from[2] - 0.2] as const;
        expect(lightAt(floor, behind(pane, 1, 0))).toBeGreaterThan(1.4 * lightAt(floor, behind(beside, 1, 0)));
      }
    }
    const [skylight] = sides.find(({ name }) => name === 'ceiling')!.openings;
    const pane = [0.9, skylight!.from[1], 2.3] as const;
    expect(lightAt(right, behind(pane, 0, 3.1))).toBeGreaterThan(1.3 * lightAt(right, [3.1, 1.6, 0]));
  });

  test('is what its tool computes, byte by byte', { tags: ['full'], timeout: 600_000 }, () => {
    const { width, height, pixels } = bakeLight();
    // Versions of zlib differ in how they pack; what they pack is compared.
    expect(filteredRows(writePng(width, height, pixels))).toEqual(filteredRows(file));
  });
});
