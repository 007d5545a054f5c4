import { DoubleSide, type Material, Mesh, type Object3D } from 'three';
import { expect, test } from 'vitest';
import { createTrails } from '../../../src/page/archery/bow/trails';
import { createBackstop } from '../../../src/page/archery/range/backstop';
import { createZone } from '../../../src/page/archery/range/zone';
import { createZoneRing } from '../../../src/page/ball/court/zone-ring';
import { createAimArc } from '../../../src/page/ball/view/aim-arc';

test('a transparent object with two sides is drawn in one pass, its program looked up once', () => {
  const drawn: Object3D[] = [
    createBackstop('low'),
    createTrails(0.7).object,
    createZone().object,
    createAimArc().object,
    createZoneRing().mesh,
  ];
  const seen: Material[] = [];
  for (const object of drawn)
    object.traverse((part) => {
      if (part instanceof Mesh) seen.push(...[part.material].flat());
    });
  const both = seen.filter(({ transparent, side }) => transparent && side === DoubleSide);
  // Three nets, trails, the zone's fence, the ring that is aimed at, the ring about a station.
  expect(both).toHaveLength(7);
  for (const material of both) expect(material.forceSinglePass).toBe(true);
});
