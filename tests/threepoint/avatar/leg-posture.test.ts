import fc from 'fast-check';
import { add, distance, fromAxisAngle, multiply, rotate, up, type Vec3, vec3, wrapAngle } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import type { LegPosture } from '../../../src/threepoint/avatar/legs/leg-posture';
import type { GaitPoints } from '../../../src/threepoint/core/estimation/gait/gait-features';
import { yawOf } from '../../../src/threepoint/core/tracking/heading';
import { createLegs, proportions, standing, walking } from './walking-person';

const rateHz = 72;

type Person = (time: number) => GaitPoints;
const feetAfter = (person: Person, seconds: number, look?: (posture: LegPosture, time: number) => void) => {
  const posture = createLegs();
  for (let frame = 0; frame <= seconds * rateHz; frame++) {
    posture.update(person(frame / rateHz), frame === 0 ? 0 : 1 / rateHz);
    look?.(posture, frame / rateHz);
  }
  return posture.legs;
};

const turned = (person: Person, yaw: number, to: Vec3): Person => {
  const turn = fromAxisAngle(up, yaw);
  const point = (p: Vec3) => add(rotate(turn, p), to);
  return (time) => {
    const { hips, head, leftHand, rightHand } = person(time);
    return {
      hips: { position: point(hips.position), orientation: multiply(turn, hips.orientation) },
      head: { position: point(head.position), orientation: multiply(turn, head.orientation) },
      leftHand: point(leftHand),
      rightHand: point(rightHand),
    };
  };
};

describe('legs', () => {
  test('stay flat on the floor on their own sides while a person stands', () => {
    const first: Vec3[] = [];
    feetAfter(standing, 5, ({ legs: { left, right } }) => {
      if (first.length === 0) first.push({ ...left.ankle }, { ...right.ankle });
      expect(distance(left.ankle, first[0]!)).toBeLessThan(1e-9);
      expect(distance(right.ankle, first[1]!)).toBeLessThan(1e-9);
      expect(left.ankle.y).toBeCloseTo(proportions.ankleHeight, 3);
    });
    expect(first[0]!.x).toBeLessThan(-0.04);
    expect(first[1]!.x).toBeGreaterThan(0.04);
  });

  test('stand on the floor while a person holds both hands high', () => {
    let lifted = 0;
    feetAfter(
      (time) => {
        const { hips, head } = standing(time);
        return { hips, head, leftHand: vec3(-0.3, 2.1, 0), rightHand: vec3(0.3, 2.1, 0) };
      },
      6,
      ({ legs: { left, right } }, time) => {
        if (time > 1 && Math.max(left.ankle.y, right.ankle.y) > proportions.ankleHeight + 0.015) lifted += 1;
      },
    );
    expect(lifted).toBe(0);
  });

  test('have the lengths of their bones, knees ahead, and nothing is NaN while a person walks', () => {
    feetAfter(walking, 6, ({ legs }) => {
      for (const { hip, knee, ankle } of Object.values(legs)) {
        expect(distance(hip, knee)).toBeCloseTo(proportions.upper, 6);
        expect(distance(knee, ankle)).toBeCloseTo(proportions.lower, 6);
      }
    });
  });

  test('keep knees and ankles over the floor while a person walks, turns, squats and kneels', {
    tags: ['full'],
  }, () => {
    const number = (min: number, max: number) => fc.double({ min, max, noNaN: true });
    const goal = fc.record({
      ...{ x: number(-1, 1), z: number(-1, 1), yaw: number(-3, 3) },
      ...{ height: number(0.12, 0.97), back: number(-0.1, 0.45) },
    });
    const property = fc.property(fc.array(goal, { minLength: 2, maxLength: 6 }), (goals) => {
      const posture = createLegs();
      const person = { x: 0, z: 0, yaw: 0, height: 0.97, back: 0.05 };
      for (const next of goals) {
        for (let frame = 0; frame < 1.5 * rateHz; frame++) {
          for (const key of ['x', 'z', 'yaw', 'height', 'back'] as const) person[key] += (next[key] - person[key]) / 15;
          const { x, z, yaw, height, back } = person;
          const at = (side: number, y: number, behind: number) =>
            add(rotate(fromAxisAngle(up, yaw), vec3(side, y, behind)), vec3(x, 0, z));
          const orientation = fromAxisAngle(up, yaw);
          const hips = { position: at(0, height, back), orientation };
          const head = { position: at(0, height + 0.6, 0), orientation };
          posture.update(
            { hips, head, leftHand: at(-0.2, height, -0.3), rightHand: at(0.2, height, -0.3) },
            1 / rateHz,
          );
          for (const { knee, ankle } of Object.values(posture.legs)) {
            expect(knee.y).toBeGreaterThan(0.05);
            expect(ankle.y).toBeGreaterThan(proportions.ankleHeight - 0.01);
          }
        }
      }
    });
    fc.assert(property, { seed: 5, numRuns: 60 });
  });

  test('step in turn while a person walks', () => {
    const lifts: string[] = [];
    const high = { left: false, right: false };
    feetAfter(walking, 8, ({ legs }, time) => {
      for (const side of ['left', 'right'] as const) {
        const now = legs[side].ankle.y > proportions.ankleHeight + 0.015;
        if (now && !high[side] && time > 2) lifts.push(side);
        high[side] = now;
      }
    });
    // Six seconds at 0.9 strides a second: five or six lifts of each foot.
    expect(lifts.length).toBeGreaterThanOrEqual(8);
    expect(lifts.filter((side, i) => i > 0 && side === lifts[i - 1]).length).toBeLessThanOrEqual(2);
  });

  test('are the same legs wherever the person is and whichever way they face', () => {
    const to = vec3(2, 0, -1);
    const plain = feetAfter(walking, 3);
    const elsewhere = feetAfter(turned(walking, 2, to), 3);
    const turn = fromAxisAngle(up, 2);
    for (const side of ['left', 'right'] as const)
      expect(distance(add(rotate(turn, plain[side].ankle), to), elsewhere[side].ankle)).toBeLessThan(1e-3);
  });

  test('come along at once when the person is moved', () => {
    const moved: Person = (time) => (time < 1 ? standing(time) : turned(standing, 0.5, vec3(3, 0, 2))(time));
    const places: Vec3[] = [];
    feetAfter(moved, 1.5, ({ legs }) => places.push({ ...legs.left.ankle }));
    const jumps = places.slice(1).filter((place, i) => distance(place, places[i]!) > 0.05);
    expect(jumps).toHaveLength(1);
    expect(distance(places.at(-1)!, vec3(3, 0.08, 2))).toBeLessThan(0.4);
  });

  test.each([
    ['a push of the stick', 72, Math.PI / 6],
    ['a push of the stick, drawn slowly', 30, -Math.PI / 6],
    ['a recentring', 72, Math.PI / 2],
    ['a recentring after a pause', 4, 3],
  ])('come along at once when %s turns the person where they stand', (_, hz, yaw) => {
    const posture = createLegs();
    const around = turned(standing, yaw, vec3(0, 0, 0));
    for (let frame = 0; frame <= 2 * hz; frame++) posture.update(standing(0), 1 / hz);
    const stood = { left: { ...posture.legs.left.ankle }, right: { ...posture.legs.right.ankle } };
    posture.update(around(0), 1 / hz);
    const turn = fromAxisAngle(up, yaw);
    for (const side of ['left', 'right'] as const) {
      const { ankle, foot } = posture.legs[side];
      expect(distance(ankle, rotate(turn, stood[side]))).toBeLessThan(0.02);
      expect(ankle.y).toBeCloseTo(proportions.ankleHeight, 3);
      expect(Math.abs(wrapAngle(yawOf(foot) - yaw))).toBeLessThan(0.5);
    }
  });

  test('step round while a person spins as fast as people do, still when on the floor', () => {
    const yaw = (time: number) => (time < 1 ? 6 * time * time : 12 * time - 6);
    const places: Vec3[] = [];
    feetAfter(
      (time) => turned(standing, yaw(time), vec3(0, 0, 0))(0),
      3,
      ({ legs }) => places.push({ ...legs.left.ankle }),
    );
    const onFloor = ({ y }: Vec3) => y < proportions.ankleHeight + 1e-3;
    const slid = places.slice(1).filter((place, i) => onFloor(place) && distance(place, places[i]!) > 0.01);
    expect(slid).toHaveLength(0);
  });
});
