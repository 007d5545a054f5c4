import fc from 'fast-check';
import type { GripOffset } from 'threepoint';
import { angleBetween, distance, dot, identity, rotate, type Side, type Vec3, vec3, zero } from 'threepoint/math';
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
    // Controllers without a profile of their own, as a PlayStation VR2 Sense: held like a Touch, corrected apart.
    const generic = ['generic-trigger-squeeze-thumbstick', 'generic-trigger'];
    expect(handleFit(generic)).toEqual(handleFit(['meta-quest-touch-plus']));
    expect(gripDevice(generic)).toBe('generic-trigger-squeeze-thumbstick');
  });

  describe('the user’s offset', () => {
    const profiles = ['meta-quest-touch-plus-v9', 'meta-quest-touch-plus', 'generic-trigger-squeeze'];
    const device = gripDevice(profiles);
    // A flat hand, palm down, whose wrist is at the origin.
    const level = { position: zero, orientation: identity };
    /** Returns the wrist that this offset makes of the level one, in a hand that holds the controller. */
    const moved = (side: Side, offset: GripOffset) => {
      const fit = handleFit(profiles);
      const grip = gripFromWrist(level, side, fit);
      return wristFromGrip(grip, side, adjustedFit(fit, profiles, side, { [device]: { [side]: offset } }));
    };

    test('is that of the device and of the hand alone', () => {
      expect(device).toBe('meta-quest-touch-plus');
      const offsets = { [device]: { left: { ahead: 0.02 } } };
      expect(adjustedFit(genericFit, ['htc-vive'], 'left', offsets)).toBe(genericFit);
      expect(adjustedFit(genericFit, profiles, 'right', offsets)).toBe(genericFit);
      expect(adjustedFit(genericFit, profiles, 'left', offsets).ahead).toBeCloseTo(0.1, 9);
    });

    test.each(['left', 'right'] as const)('moves the %s wrist along the axes of the hand', (side) => {
      const thumb = side === 'left' ? 1 : -1;
      for (const [offset, x, y, z] of [
        [{ ahead: 0.02 }, 0, 0, 0.02],
        [{ below: 0.02 }, 0, 0.02, 0],
        [{ thumbward: 0.02 }, -0.02 * thumb, 0, 0],
      ] as const) {
        expect(distance(moved(side, offset).position, vec3(x, y, z))).toBeLessThan(1e-9);
      }
    });

    test.each(['left', 'right'] as const)('turns the %s hand about the fist, which stays', (side) => {
      const thumb = side === 'left' ? 1 : -1;
      const fist = gripFromWrist(level, side, handleFit(profiles)).position;
      const turnedTo = (offset: GripOffset, axis: Vec3) => rotate(moved(side, offset).orientation, axis);
      const [fingers, thumbSide] = [vec3(0, 0, -1), vec3(thumb, 0, 0)];
      expect(Math.sign(turnedTo({ lean: 0.2 }, fingers).x), 'fingers to the thumb’s side').toBe(thumb);
      expect(turnedTo({ pitch: -0.2 }, fingers).y, 'fingers up').toBeCloseTo(Math.sin(0.2), 9);
      expect(turnedTo({ roll: 0.2 }, thumbSide).y, 'thumb down').toBeCloseTo(-Math.sin(0.2), 9);
      for (const offset of [{ lean: 0.2 }, { pitch: 0.2 }, { roll: 0.2 }]) {
        const wrist = moved(side, offset);
        expect(angleBetween(wrist.orientation, identity)).toBeCloseTo(0.2, 9);
        expect(distance(wrist.position, fist)).toBeCloseTo(distance(zero, fist), 9);
      }
    });
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
