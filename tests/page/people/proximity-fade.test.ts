import type { AvatarPose } from 'threepoint/core';
import { identity, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { proximityFade } from '../../../src/page/people/match/proximity-fade';

const tracked = (position: Vec3) => ({ position, orientation: identity, tracking: 'tracked' as const });
const standing = (hand: Vec3 | null = null): AvatarPose => ({
  head: tracked(vec3(0, 1.6, 0)),
  leftHand: hand && tracked(hand),
  rightHand: null,
  body: null,
});
/** Their floor lies two metres ahead, turned to face the viewer. */
const ahead = { position: vec3(0, 0, -2), orientation: { x: 0, y: 1, z: 0, w: 0 } };
const shown = (eyes: Vec3, pose = standing()) => proximityFade(eyes, pose, ahead);

describe('personal space', () => {
  test('others are whole beyond half a metre and gone at 0.2 m, wherever their floor lies', () => {
    expect(shown(vec3(0, 1.6, 0))).toBe(1);
    expect(shown(vec3(0, 1.6, -1.49))).toBe(1);
    expect(shown(vec3(0, 1.6, -1.81))).toBe(0);
  });

  test('they fade evenly on the way, and never come back nearer by', () => {
    let before = 1;
    for (let metres = 0.5; metres >= 0; metres -= 0.01) {
      const now = shown(vec3(metres, 1.6, -2));
      expect(now).toBeLessThanOrEqual(before);
      expect(before - now).toBeLessThan(0.06);
      before = now;
    }
    expect(before).toBe(0);
  });

  test('a trunk fades as a head does for lower eyes; a hand before the eyes too', () => {
    expect(shown(vec3(0, 1.2, -1.85))).toBe(0);
    expect(shown(vec3(0, 1.6, -0.1), standing(vec3(0, 1.6, -1.8)))).toBeLessThan(0.1);
    expect(shown(vec3(0, 0.3, -2))).toBe(1);
  });
});
