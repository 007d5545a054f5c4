import { fileURLToPath } from 'node:url';
import sharp from 'sharp';
import { describe, expect, test } from 'vitest';
import { layOutLightMap, mapWidth, type Patch } from '../../../src/page/studio/room/light-map';
import { sides, towardsSun } from '../../../src/page/studio/room/room-plan';
import { bakeLight } from '../../../tools/studio/bake-light';

const file = fileURLToPath(new URL('../../../src/page/studio/room/light-map.png', import.meta.url));
const map = await sharp(file).raw().toBuffer({ resolveWithObject: true });

const { patches, mapHeight } = layOutLightMap();
const patchOf = (name: string) => patches.find(({ side }) => side?.name === name)!;

/** Returns the green of the map at a point of a side of the room, floor frame [m]. */
function lightAt(patch: Patch, at: readonly [number, number, number]): number {
  const share = (edge: Patch['u']) =>
    edge.reduce((sum, value, i) => sum + (at[i]! - patch.origin[i]!) * value, 0) /
    edge.reduce((sum, v) => sum + v * v, 0);
  const x = Math.round(patch.x + share(patch.u) * (patch.columns - 1));
  const y = Math.round(patch.y + share(patch.v) * (patch.rows - 1));
  return map.data[3 * (y * map.info.width + x) + 1]!;
}

describe('the light map of the studio', () => {
  test('has the size that the room needs, and no two patches share a texel', () => {
    const { width, height, channels } = map.info;
    expect([width, height, channels]).toEqual([mapWidth, mapHeight, 3]);
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
    const { pixels } = bakeLight();
    expect(Buffer.from(pixels).equals(map.data)).toBe(true);
  });
});
