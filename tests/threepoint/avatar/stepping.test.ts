import { distance, type Side, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { type Feet, type Stance, Stepping } from '../../../src/threepoint/avatar/legs/stepping';
import type { ExpectedFoot } from '../../../src/threepoint/core/estimation/gait/gait';

const stance: Stance = { ankleHeight: 0.08, legLength: 0.85 };
type Goals = Record<Side, ExpectedFoot>;

/** Feet beside a place, both standing. */
const beside = (x: number, z: number, yaw = 0): Goals => ({
  left: { x: x - 0.1 * Math.cos(yaw), z: z + 0.1 * Math.sin(yaw), lift: 0, yaw, standing: 0.95 },
  right: { x: x + 0.1 * Math.cos(yaw), z: z - 0.1 * Math.sin(yaw), lift: 0, yaw, standing: 0.95 },
});

/**
 * What is expected of a walker, half a second a step, 1.1 m/s towards −Z: one foot stands, the other goes twice as fast
 * as the walker.
 */
function walking(time: number): Goals {
  const foot = (x: number, phase: number): ExpectedFoot => {
    const cycle = time + phase;
    const share = cycle - Math.floor(cycle);
    const way = (Math.floor(cycle) + Math.min(1, Math.max(0, 2 * share - 1)) - phase) * 1.1;
    return { x, z: -way, lift: share < 0.5 ? 0 : 0.06, yaw: 0, standing: share < 0.5 ? 0.9 : 0.1 };
  };
  return { left: foot(-0.1, 0), right: foot(0.1, 0.5) };
}

/** Hips over both goals, within reach. */
const above = ({ left, right }: Goals) => ({
  left: { hip: vec3(left.x, 0.85, left.z) },
  right: { hip: vec3(right.x, 0.85, right.z) },
});

const stepTo = (stepping: Stepping, goals: Goals, deltaSeconds: number): Feet =>
  stepping.update(goals, above(goals), stance, deltaSeconds);

/** Steps through goals at a frame rate and hands each frame's feet to `look`. */
function step(
  goalsAt: (time: number) => Goals,
  seconds: number,
  rateHz: number,
  look: (feet: Feet, time: number) => void,
) {
  const stepping = new Stepping();
  for (let frame = 0; frame <= seconds * rateHz; frame++) {
    const time = frame / rateHz;
    // A copy: the feet are the same object in every frame.
    look(structuredClone(stepTo(stepping, goalsAt(time), frame === 0 ? 0 : 1 / rateHz)), time);
  }
}

describe('feet', () => {
  test('stand still while their goals sway', () => {
    let first: Feet | null = null;
    step(
      (t) => beside(0.08 * Math.sin(3 * t), 0.06 * Math.cos(2 * t), 0.2 * Math.sin(t)),
      6,
      60,
      (feet) => {
        first ??= feet;
        expect(feet.left.planted && feet.right.planted).toBe(true);
        expect(distance(feet.left.position, first.left.position)).toBe(0);
      },
    );
  });

  test.each([60, 72, 90, 120])('never slide while planted, and never sink, at %i Hz', (rate) => {
    let before: Feet | null = null;
    let planted = 0;
    step(walking, 4, rate, (feet) => {
      for (const side of ['left', 'right'] as const) {
        const now = feet[side];
        const then = before?.[side];
        if (now.planted && then?.planted) {
          planted += 1;
          expect(Math.hypot(now.position.x - then.position.x, now.position.z - then.position.z)).toBe(0);
        }
        expect(now.position.y).toBeGreaterThanOrEqual(stance.ankleHeight - 1e-9);
        // The ball of the foot, 13 cm ahead of the ankle, stays above the floor.
        expect(now.position.y - stance.ankleHeight).toBeGreaterThanOrEqual(0.128 * Math.sin(now.pitch) - 1e-9);
      }
      before = feet;
    });
    expect(planted).toBeGreaterThan(2 * rate);
  });

  test('are lifted in each step of a walker and keep up', () => {
    const steps = { left: 0, right: 0 };
    let before: Feet | null = null;
    step(walking, 6, 72, (feet, time) => {
      for (const side of ['left', 'right'] as const)
        if (before?.[side].planted && !feet[side].planted) steps[side] += 1;
      const middle = (feet.left.position.z + feet.right.position.z) / 2;
      const expected = (walking(time).left.z + walking(time).right.z) / 2;
      if (time > 1) expect(Math.abs(middle - expected)).toBeLessThan(0.3);
      before = feet;
    });
    for (const side of ['left', 'right'] as const) {
      expect(steps[side]).toBeGreaterThanOrEqual(5);
      expect(steps[side]).toBeLessThanOrEqual(7);
    }
  });

  test('step once when they are left behind, though they are expected to stand', () => {
    let lifted = 0;
    let last: Feet | null = null;
    step(
      (t) => (t < 1 ? beside(0, 0) : beside(0.6, 0)),
      3,
      60,
      (feet) => {
        if (last?.left.planted && !feet.left.planted) lifted += 1;
        last = feet;
      },
    );
    const { left, right } = last as unknown as Feet;
    expect(lifted).toBe(1);
    expect(left.planted && right.planted).toBe(true);
    expect(Math.abs(left.position.x - 0.5)).toBeLessThan(0.1);
  });

  test('are not in the air for longer than a step, however surely they are expected', () => {
    let longest = 0;
    let since = 0;
    step(
      (t) => {
        const { left, right } = beside(0.3 * t, 0);
        return { left: { ...left, standing: 0.05 }, right: { ...right, standing: 0.05 } };
      },
      6,
      60,
      ({ left }, time) => {
        if (left.planted) since = time;
        longest = Math.max(longest, time - since);
      },
    );
    expect(longest).toBeLessThan(1);
  });

  test('follow a turn on the spot', () => {
    let yaw = 0;
    step(
      (t) => beside(0, 0, Math.min(t, 2)),
      4,
      60,
      (feet) => {
        yaw = (feet.left.yaw + feet.right.yaw) / 2;
      },
    );
    expect(Math.abs(yaw - 2)).toBeLessThan(0.85);
  });

  test('stand where they are expected after a reset', () => {
    const stepping = new Stepping();
    stepTo(stepping, beside(0, 0), 1 / 60);
    stepping.reset();
    const places: Vec3[] = [stepTo(stepping, beside(3, 2), 1 / 60).left.position];
    expect(places[0]?.x).toBeCloseTo(2.9, 6);
    expect(places[0]?.z).toBeCloseTo(2, 6);
  });
});
