import fc from 'fast-check';
import { distance, dot, rotate, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import {
  bareHandFit,
  genericFit,
  gripFromWrist,
  handleFit,
  wristFromGrip,
} from '../../../src/threepoint/xr/grip-offsets';
import { fromEulerYxz } from '../core/euler-angles';

const angle = fc.double({ min: -3, max: 3, noNaN: true });
const metre = fc.double({ min: -3, max: 3, noNaN: true });

describe('a controller in the hand', () => {
  test('the wrist lies behind the fist and above it, palms facing each other, thumbs up', () => {
    for (const side of ['left', 'right'] as const) {
      // Grips as the specification draws them: the handle points up and ahead, X out of the back of the hand.
      const grip = { position: vec3(0, 1, -0.4), orientation: fromEulerYxz(vec3(Math.PI / 4, 0, 0)) };
      const wrist = wristFromGrip(grip, side, genericFit);
      expect(wrist.position.z).toBeGreaterThan(-0.4 + 0.06);
      const knuckles = rotate(wrist.orientation, vec3(0, 0, -1));
      expect(knuckles.z).toBeLessThan(-0.99);
      const back = rotate(wrist.orientation, vec3(0, 1, 0));
      expect(back.x).toBeCloseTo(side === 'right' ? 1 : -1, 5);
      // The palm, not the back of the hand, lies on the handle.
      expect(dot(back, vec3(grip.position.x - wrist.position.x, 0, 0))).toBeLessThan(0);
    }
  });

  test('grip and wrist are each other’s inverse, however the hand is turned', () => {
    fc.assert(
      fc.property(angle, angle, angle, metre, metre, metre, (x, y, z, px, py, pz) => {
        const grip = { position: vec3(px, py, pz), orientation: fromEulerYxz(vec3(x, y, z)) };
        for (const side of ['left', 'right'] as const) {
          const back = gripFromWrist(wristFromGrip(grip, side, genericFit), side, genericFit);
          expect(distance(back.position, grip.position)).toBeLessThan(1e-9);
          expect(back.orientation).toBeSameRotationAs(grip.orientation, 1e-5);
        }
      }),
    );
  });

  test('the first known profile decides; unknown devices get the generic fit', () => {
    expect(handleFit(['no-such-device', 'htc-vive', 'generic-trigger'])).toEqual(handleFit(['htc-vive']));
    expect(handleFit(['no-such-device'])).toEqual(genericFit);
  });

  test.each([
    ['generic-hand', 'generic-hand-select', 'generic-trigger'],
    ['oculus-hand', 'generic-trigger'],
    ['generic-hand-select-grasp'],
  ])('%s is a bare hand, whose grip lies straight across the palm', (...profiles) => {
    expect(handleFit(profiles)).toEqual(bareHandFit);
    expect(handleFit(['meta-quest-touch-plus', ...profiles])).not.toEqual(bareHandFit);
  });
});
