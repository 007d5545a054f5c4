import { describe, expect, test } from 'vitest';
import { createStepping, type Feet, type Stance } from '../../src/avatar/stepping';
import { distance, type Vec3, vec3 } from '../../src/core/math/vec3';

const standing: Stance = { pelvis: vec3(0, 0.95, 0), yaw: 0, halfWidth: 0.1, ankleHeight: 0.08, legLength: 0.85 };
const at = (x: number, z: number, yaw = 0): Stance => ({ ...standing, pelvis: vec3(x, 0.95, z), yaw });

/** Walks through stances at a frame rate and hands each frame's feet to `look`. */
function walk(
  stanceAt: (time: number) => Stance,
  seconds: number,
  rateHz: number,
  look: (feet: Feet, time: number) => void,
) {
  const stepping = createStepping();
  for (let frame = 0; frame <= seconds * rateHz; frame++) {
    const time = frame / rateHz;
    // A copy: the feet are the same object in every frame.
    look(structuredClone(stepping.update(stanceAt(time), frame === 0 ? 0 : 1 / rateHz)), time);
  }
}

describe('feet', () => {
  test('stand still under a person who sways', () => {
    let first: Feet | null = null;
    walk(
      (t) => at(0.04 * Math.sin(3 * t), 0.03 * Math.cos(2 * t)),
      6,
      60,
      (feet) => {
        first ??= feet;
        expect(feet.left.planted && feet.right.planted).toBe(true);
        expect(distance(feet.left.position, first.left.position)).toBe(0);
      },
    );
  });

  test.each([60, 72, 90, 120])('never slide while planted, and one is always on the floor, at %i Hz', (rate) => {
    let before: Feet | null = null;
    let planted = 0;
    walk(
      (t) => at(0, -0.9 * t),
      4,
      rate,
      (feet) => {
        expect(feet.left.planted || feet.right.planted).toBe(true);
        for (const side of ['left', 'right'] as const) {
          const now = feet[side];
          const then = before?.[side];
          if (now.planted && then?.planted) {
            planted += 1;
            expect(distance(now.position, then.position)).toBe(0);
          }
          expect(now.position.y).toBeGreaterThanOrEqual(standing.ankleHeight - 1e-9);
        }
        before = feet;
      },
    );
    // One of the two feet at least, in most of the four seconds.
    expect(planted).toBeGreaterThan(2 * rate);
  });

  test('keep up with a person who walks', () => {
    let last: Feet | null = null;
    walk(
      (t) => at(0, -1.1 * Math.min(t, 4)),
      6,
      72,
      (feet, time) => {
        const middle = (feet.left.position.z + feet.right.position.z) / 2;
        if (time > 1) expect(Math.abs(middle + 1.1 * Math.min(time, 4))).toBeLessThan(0.45);
        last = feet;
      },
    );
    const { left, right } = last as unknown as Feet;
    expect(left.planted && right.planted).toBe(true);
  });

  test('follow a turn on the spot', () => {
    let yaw = 0;
    walk(
      (t) => at(0, 0, Math.min(t, 2)),
      4,
      60,
      (feet) => {
        yaw = (feet.left.yaw + feet.right.yaw) / 2;
      },
    );
    expect(Math.abs(yaw - 2)).toBeLessThan(0.6);
  });

  test('come along at once when the person is moved', () => {
    const places: Vec3[] = [];
    walk(
      (t) => (t < 1 ? at(0, 0) : at(3, 2)),
      1.2,
      60,
      (feet) => places.push(feet.left.position),
    );
    const jumps = places.slice(1).filter((place, i) => distance(place, places[i] as Vec3) > 0.2);
    expect(jumps).toHaveLength(1);
  });
});
