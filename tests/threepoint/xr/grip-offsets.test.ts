import fc from 'fast-check';
import { angleBetween, distance, dot, identity, rotate, vec3, zero } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { rotateInverse } from '../../../src/threepoint/core/math/quat';
import {
  adjustedFit,
  bareHandFit,
  genericFit,
  gripDevice,
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

  test('the user’s offset moves the wrist back and turns it, for their device alone', () => {
    const profiles = ['meta-quest-touch-plus-v9', 'meta-quest-touch-plus', 'generic-trigger-squeeze'];
    const device = gripDevice(profiles);
    expect(device).toBe('meta-quest-touch-plus');
    const offsets = { [device]: { ahead: 0.02, lean: 0.2 } };
    expect(adjustedFit(genericFit, ['htc-vive'], offsets)).toBe(genericFit);
    const grip = { position: vec3(0, 1, -0.4), orientation: fromEulerYxz(vec3(Math.PI / 4, 0, 0)) };
    for (const side of ['left', 'right'] as const) {
      const before = wristFromGrip(grip, side, handleFit(profiles));
      const after = wristFromGrip(
        grip,
        side,
        adjustedFit(handleFit(profiles), profiles, { [device]: { ahead: 0.02, lean: 0 } }),
      );
      expect(distance(before.position, after.position)).toBeCloseTo(0.02, 9);
      expect(after.position.z).toBeGreaterThan(before.position.z + 0.019);
      const turned = wristFromGrip(grip, side, adjustedFit(handleFit(profiles), profiles, offsets));
      expect(angleBetween(before.orientation, turned.orientation)).toBeCloseTo(0.2, 9);
    }
  });

  test('a pen lies before the knuckles, with its tip ahead', () => {
    const wrist = wristFromGrip({ position: zero, orientation: identity }, 'right', handleFit(['logitech-mx-ink']));
    const tip = rotateInverse(wrist.orientation, vec3(0, 0, -1));
    expect(tip.z).toBeLessThan(-0.9);
    expect(distance(wrist.position, zero)).toBeGreaterThan(0.11);
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
