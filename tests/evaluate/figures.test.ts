import { add, fromAxisAngle, rotate, up, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { drive } from '../../bench/evaluate/drive';
import { addPictures, inOrder, motions, type Pictures, unlikeness } from '../../bench/evaluate/figures';
import type { MeasuredFrame } from '../../bench/evaluate/measures';
import { person, recordedMotion } from './recorded-motion';

type Truth = MeasuredFrame['truth'];

/**
 * A person upright with the wrists right, up and forward of the shoulders' middle [m], turned by yaw and standing
 * anywhere.
 */
function standing(left: Vec3, right: Vec3, yaw = 0, leanSideways = 0): Truth {
  const shoulders = vec3(leanSideways, 1.4, 0);
  const hand = ({ x, y, z }: Vec3) => add(shoulders, vec3(x, y, -z));
  const joints: Truth = {
    hips: vec3(0, 0.95, 0),
    chest: vec3(leanSideways / 2, 1.2, 0),
    neck: add(shoulders, vec3(0, 0.05, 0)),
    head: add(shoulders, vec3(0, 0.2, 0)),
    leftUpperArm: add(shoulders, vec3(-0.18, 0, 0)),
    rightUpperArm: add(shoulders, vec3(0.18, 0, 0)),
    leftLowerArm: add(shoulders, vec3(-0.18, -0.3, 0)),
    rightLowerArm: add(shoulders, vec3(0.18, -0.3, 0)),
    leftHand: hand(left),
    rightHand: hand(right),
  };
  const turned = (point: Vec3) => add(rotate(fromAxisAngle(up, yaw), point), vec3(3, 0, -2));
  return Object.fromEntries(Object.entries(joints).map(([name, point]) => [name, turned(point)])) as Truth;
}

const nearest = (truth: Truth) => [...motions].sort((a, b) => unlikeness(a, truth) - unlikeness(b, truth))[0];

describe('the six motions', () => {
  test.each([
    ['left block', vec3(-0.05, 0.15, 0.28), vec3(0.2, -0.3, 0.1)],
    ['right block', vec3(-0.2, -0.3, 0.1), vec3(0.05, 0.15, 0.28)],
    ['lift', vec3(-0.15, 0.45, 0.2), vec3(0.15, 0.45, 0.2)],
    ['right hand in front', vec3(-0.2, -0.5, 0.05), vec3(0.15, 0, 0.55)],
    ['folded arms', vec3(0.12, -0.25, 0.2), vec3(-0.12, -0.25, 0.2)],
  ] as const)('%s is known by the wrists, whichever way the person faces', (motion, left, right) => {
    for (const yaw of [0, 1, 3, -2]) expect(nearest(standing(left, right, yaw))).toBe(motion);
  });

  test('a sway is a trunk to one side, either one', () => {
    const [left, right] = [vec3(-0.5, -0.3, 0), vec3(0.5, -0.3, 0)];
    for (const lean of [-0.17, 0.17]) {
      expect(unlikeness('sway', standing(left, right, 1, lean))).toBeLessThan(0.1);
    }
    expect(unlikeness('sway', standing(left, right, 1, 0))).toBeGreaterThan(0.5);
  });
});

describe('the figures of an evaluation', () => {
  test('are one pose for each motion, seen from one side', async () => {
    const pictures: Pictures = new Map();
    for (const seed of [1, 2, 3]) {
      const ik = await drive('ik', person, null, recordedMotion(seed, 330));
      addPictures(pictures, `clip ${seed}`, { ik }, 60);
    }
    const poses = inOrder(pictures);
    expect(poses.map(({ motion }) => motion)).toEqual(motions);
    for (const { bodies } of poses) {
      const [left, right] = [bodies.truth.leftUpperArm, bodies.truth.rightUpperArm];
      // Facing the same way in every picture: the right shoulder to the right, as far back as the left.
      expect(right[0]).toBeGreaterThan(left[0]);
      expect(right[2]).toBeCloseTo(left[2], 3);
      expect(Math.hypot(bodies.truth.hips[0], bodies.truth.hips[2])).toBeLessThan(1e-6);
    }
  });
});
