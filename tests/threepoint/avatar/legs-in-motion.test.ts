import fc from 'fast-check';
import { distance, dot, fromAxisAngle, lerp, right, rotate, subtract, up, type Vec3, wrapAngle } from 'threepoint/math';
import { beforeAll, describe, expect, test } from 'vitest';
import { createEstimator } from '../../../src/threepoint/core/estimation/estimators';
import { yawOf } from '../../../src/threepoint/core/tracking/heading';
import { cases } from '../../nightly';
import { seed } from '../core/arbitraries';
import { openPlainModel } from '../core/estimation/shipped-models';
import { type ActedFrame, actedFrames, acts, calibration, legProportions as proportions } from './acting-person';
import { eyeHeight } from './walking-person';

const across = (a: Vec3, b: Vec3): number => Math.hypot(a.x - b.x, a.z - b.z);

/** Acts that threw both knees to one side: a look aside, a hand to the other shoulder, a quick crouch. */
const lookAndCrouch = (jumps: boolean) => [
  { seconds: 0.3, look: 1.4 },
  { seconds: 0.3, look: 0 },
  { seconds: 0.5, across: 1, jumps },
  { seconds: 1.2, eyes: 0.75 },
];

describe('legs of a person who walks, turns, crouches, jumps, sits and lunges', () => {
  let frames: ActedFrame[];
  beforeAll(() => {
    const scripts = fc.sample(acts, { seed, numRuns: cases(16) });
    frames = [lookAndCrouch(false), lookAndCrouch(true), ...scripts].flatMap((script) => actedFrames(script));
  });
  const rested = (isUpright: boolean) =>
    frames.filter(({ rested, posture }) => rested && (!isUpright || posture.eyes > 0.95 * eyeHeight));

  test('have hips, knees and ankles over the floor by the girth of these joints', () => {
    for (const { legs, act } of frames) {
      for (const { hip, knee, ankle } of Object.values(legs)) {
        expect(hip.y, act).toBeGreaterThan(0.099);
        expect(knee.y, act).toBeGreaterThan(0.059);
        expect(ankle.y, act).toBeGreaterThan(proportions.ankleHeight - 1e-9);
      }
    }
  });

  test('reach their feet with bones of one length', () => {
    for (const { legs, act } of frames) {
      for (const { hip, knee, ankle } of Object.values(legs)) {
        expect(distance(hip, knee), act).toBeCloseTo(proportions.upper, 5);
        expect(distance(knee, ankle), act).toBeCloseTo(proportions.lower, 5);
      }
    }
  });

  test('have a heel within 2 cm of the floor after a second of rest', () => {
    const still = rested(false);
    expect(still.length).toBeGreaterThan(50);
    for (const { legs, act } of still)
      expect(Math.min(legs.left.ankle.y, legs.right.ankle.y), act).toBeLessThan(proportions.ankleHeight + 0.02);
  });

  test('stand under the hips of an upright person, toes ahead, after a second of rest', () => {
    const still = rested(true);
    expect(still.length).toBeGreaterThan(25);
    for (const { legs, hips, hipsYaw, act } of still) {
      // The sole's middle lies 4 cm ahead of the ankle.
      expect(across(lerp(legs.left.ankle, legs.right.ankle, 0.5), hips), act).toBeLessThan(0.15);
      for (const { foot, ankle } of Object.values(legs)) {
        expect(across(ankle, hips), act).toBeLessThan(0.35);
        expect(Math.abs(wrapAngle(yawOf(foot) - hipsYaw)), act).toBeLessThan(0.9);
      }
    }
  });

  test('have their knees on their own sides after a second of rest', () => {
    for (const { legs, posture, act } of rested(false)) {
      const aside = rotate(fromAxisAngle(up, posture.yaw), right);
      expect(dot(subtract(legs.right.knee, legs.left.knee), aside), act).toBeGreaterThan(0);
    }
  });
});

describe('legs of a person who slowly crouches', () => {
  const heights = [0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1];
  const crouches = (['ik', 'learned'] as const).flatMap((method) => heights.map((eyes) => [method, eyes] as const));

  test.each(crouches)('have knees and feet side by side by %s with eyes at %d m', (method, eyes) => {
    // An exact mirror image would hide what a centimetre decides.
    const crouch = { seconds: 4, eyes, x: 0.01, ahead: 0.05 };
    const { left, right } = actedFrames([crouch], createEstimator(method, calibration, openPlainModel())).at(-1)!.legs;
    expect(Math.abs(left.knee.y - right.knee.y)).toBeLessThan(0.05);
    expect(Math.abs(left.ankle.z - right.ankle.z)).toBeLessThan(0.1);
  });
});
