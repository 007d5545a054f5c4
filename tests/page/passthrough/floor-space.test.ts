import { describe, expect, test } from 'vitest';
import { detectedFloors, hasSpace } from '../../../src/page/passthrough/floor-space';

const rectangle = (halfWidth: number, ahead: number, behind: number) => [
  { x: -halfWidth, z: -ahead },
  { x: halfWidth, z: -ahead },
  { x: halfWidth, z: behind },
  { x: -halfWidth, z: behind },
];
const needs = { halfWidth: 1.75, ahead: 5.6, behind: 0.5 };

describe('a floor', () => {
  test.each([
    ['larger in every direction', rectangle(2, 6, 1), true],
    ['too narrow', rectangle(1.5, 6, 1), false],
    ['too short', rectangle(2, 5, 1), false],
    ['ending right behind the user', rectangle(2, 6, 0.2), false],
    ['large enough, with a corner cut off where the game is', [...rectangle(2, 6, 1), { x: 0, z: -2 }], false],
    ['that was not detected', [], false],
  ])('%s', (_, polygon, enough) => {
    expect(hasSpace(polygon, needs)).toBe(enough);
  });
});

describe('the floors that a device detects', () => {
  /** A plane whose space lies at x, y, z and is turned by a quarter about Y. */
  const plane = (orientation: string, semanticLabel: string | undefined, y = 0) => ({
    orientation,
    semanticLabel,
    polygon: rectangle(1, 2, 2).map((point) => ({ ...point, y: 0 })),
    planeSpace: { y },
  });
  const frameWith = (...planes: readonly ReturnType<typeof plane>[]) =>
    ({
      detectedPlanes: new Set(planes),
      getPose: ({ y }: { y: number }) => ({
        transform: { position: { x: 3, y, z: 0 }, matrix: [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 3, y, 0, 1] },
      }),
    }) as unknown as XRFrame;
  const space = {} as XRReferenceSpace;

  test('are its horizontal planes at the height of the floor, in the floor frame', () => {
    const floor = plane('horizontal', 'floor');
    const found = detectedFloors(
      frameWith(
        floor,
        plane('horizontal', 'table', 0.1),
        plane('horizontal', undefined, 0.8),
        plane('vertical', 'wall'),
      ),
      space,
    );
    expect(found).toHaveLength(1);
    // The plane's +X is the floor frame's −Z, and its +Z the floor frame's +X.
    expect(found[0]?.[0]).toEqual({ x: 1, z: 1 });
  });

  test('are none on a device without plane detection', () => {
    expect(detectedFloors({} as XRFrame, space)).toEqual([]);
  });
});
