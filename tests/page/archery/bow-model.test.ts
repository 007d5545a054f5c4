import fc from 'fast-check';
import { type BufferAttribute, type Group, Mesh, Vector3 } from 'three';
import { distance, type Vec3, vec3 } from 'threepoint/math';
import { braceHeight, maximumDraw } from 'threepoint-games/archery';
import { describe, expect, it } from 'vitest';
import { createBow } from '../../../src/page/archery/bow/bow-model';
import { stringBow } from '../../../src/page/archery/bow/limb-shape';
import { bowView } from '../../games/archery/bow-view';
import { fromEulerYxz } from '../../threepoint/core/euler-angles';

/** The string as it is drawn, from the upper tip over the nock point to the lower tip, floor frame. */
function drawnString(bow: Group): readonly [Vec3, Vec3, Vec3] {
  bow.updateMatrixWorld();
  const [upper, lower] = [bow.children[2]!, bow.children[3]!];
  const tip = vec3(0, -0.5, 0);
  return [
    upper.localToWorld(new Vector3().copy(tip)),
    upper.localToWorld(new Vector3(0, 0.5, 0)),
    lower.localToWorld(new Vector3().copy(tip)),
  ];
}

const draws = fc.double({ min: 0, max: maximumDraw, noNaN: true });
const angle = fc.double({ min: -3, max: 3, noNaN: true });
const turns = fc.record({ x: angle, y: angle, z: angle }).map(({ x, y, z }) => fromEulerYxz(vec3(x / 2, y, z / 3)));
const places = fc.record({ x: angle, y: angle, z: angle }).map(({ x, y, z }) => vec3(x, 1.4 + y / 10, z));
const slips = fc
  .record({
    x: fc.double({ min: -0.06, max: 0.06, noNaN: true }),
    y: fc.double({ min: -0.06, max: 0.06, noNaN: true }),
  })
  .map(({ x, y }) => vec3(x, y, 0));

describe('the bow', () => {
  it('has a string that passes through the nock point, wherever the hand pulls it', () => {
    const bow = createBow('low', braceHeight);
    fc.assert(
      fc.property(draws, places, turns, slips, (draw, at, turn, slip) => {
        const view = bowView(draw, { at, turn, slip });
        bow.show(view);
        // A cylinder that points straight down is turned by no less than 0.14 mrad: three.js rounds a smaller angle.
        expect(distance(drawnString(bow.object)[1], view.nockPoint)).toBeLessThan(1e-4);
      }),
      { seed: 4 },
    );
  });

  it('keeps the length of its string while it is drawn', () => {
    const bow = createBow('low', braceHeight);
    const { stringLength } = stringBow(braceHeight);
    fc.assert(
      fc.property(draws, turns, slips, (draw, turn, slip) => {
        bow.show(bowView(draw, { turn, slip }));
        const [upper, nock, lower] = drawnString(bow.object);
        // A nock off the straight line between the tips already pulls a little at rest.
        expect(Math.abs(distance(upper, nock) + distance(nock, lower) - stringLength)).toBeLessThan(1e-4);
      }),
      { seed: 5 },
    );
  });

  it('has a straight string at rest, at brace height before the grip', () => {
    const bow = createBow('low', braceHeight);
    const at = vec3(0, 1.4, -0.6);
    bow.show(bowView(0, { at }));
    const [upper, , lower] = drawnString(bow.object);
    expect(upper.z - at.z).toBeCloseTo(braceHeight, 3);
    expect(lower.z - at.z).toBeCloseTo(braceHeight, 3);
  });

  it('bends its limbs further with every bit of draw, tips back and together', () => {
    const bow = createBow('low', braceHeight);
    let before = { span: Infinity, back: -Infinity };
    for (let draw = 0; draw <= maximumDraw; draw += 0.05) {
      bow.show(bowView(draw));
      const [upper, , lower] = drawnString(bow.object);
      const now = { span: upper.y - lower.y, back: upper.z };
      expect(now.span).toBeLessThan(before.span);
      expect(now.back).toBeGreaterThan(before.back);
      before = now;
    }
  });

  it('ties the string to the very tips of the limbs it draws', () => {
    const bow = createBow('low', braceHeight);
    bow.show(bowView(0.5, { at: vec3(0, 0, 0) }));
    const limbs = bow.object.children[1];
    if (!(limbs instanceof Mesh)) throw new Error('the second part of the bow is not its limbs');
    const position = limbs.geometry.getAttribute('position') as BufferAttribute;
    const nearest = (to: { x: number; y: number; z: number }) => {
      let least = Infinity;
      for (let i = 0; i < position.count; i++) {
        least = Math.min(least, distance(vec3(position.getX(i), position.getY(i), position.getZ(i)), to));
      }
      return least;
    };
    const [upper, , lower] = drawnString(bow.object);
    expect(nearest(upper)).toBeLessThan(0.01);
    expect(nearest(lower)).toBeLessThan(0.01);
  });

  it('is not seen where no hand holds it', () => {
    const bow = createBow('low', braceHeight);
    bow.show(bowView(0.2));
    expect(bow.object.visible).toBe(true);
    bow.show(null);
    expect(bow.object.visible).toBe(false);
  });
});
