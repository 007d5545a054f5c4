import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { LimbBones } from '../../../../src/threepoint/core/body/two-bone-ik';
import {
  type ArmDirections,
  type ArmGoal,
  copyArmDirections,
  followTransition,
  makeArmDirections,
  makeArmTransition,
  startTransition,
} from '../../../../src/threepoint/core/estimation/arms/arm-transition';
import { fromAxisAngle, rotate } from '../../../../src/threepoint/core/math/quat';
import {
  add,
  addScaled,
  cross,
  distance,
  dot,
  length,
  normalise,
  scale,
  up,
  type Vec3,
  vec3,
} from '../../../../src/threepoint/core/math/vec3';
import { direction, evenly, seed } from '../arbitraries';

const bones: LimbBones = { upper: 0.28, lower: 0.26 };
/** The direction through which an arm swings all the way round: to the right and ahead. */
const outside = normalise(vec3(1, -0.2, -1));
/**
 * Speed of elbow and wrist at most [m/s], as if the hand stood still; over a longer path what takes them along it in
 * 0.7 s, 0.05 of them to get up to speed and down.
 */
const fastestOver = (metres: number): number => Math.max(2.25, metres / 0.65);
/** How far elbow or wrist go from frame to frame in all [m], whichever goes further in each. */
const pathOf = (arms: readonly ArmDirections[]): number =>
  arms.slice(1).reduce((metres, to, i) => {
    const from = arms[i]!;
    return metres + Math.max(distance(wristOf(to), wristOf(from)), distance(elbowOf(to), elbowOf(from)));
  }, 0);

const arm = fc.record({ upperArm: direction, forearm: direction }).map(({ upperArm, forearm }): ArmDirections => {
  const normal = cross(upperArm, forearm);
  return { upperArm, forearm, hinge: normalise(normal, normalise(cross(upperArm, vec3(0.3, 0.5, 0.8)))) };
});

const elbowOf = ({ upperArm }: ArmDirections): Vec3 => scale(upperArm, bones.upper);
const wristOf = (directions: ArmDirections): Vec3 => addScaled(elbowOf(directions), directions.forearm, bones.lower);
/** What is wanted of an arm whose hand is seen, and whose shoulder stands still at the origin. */
const wantedOf = (directions: ArmDirections): ArmGoal => ({
  ...directions,
  shoulder: vec3(0, 0, 0),
  hand: wristOf(directions),
  bones,
  outside,
  minDuration: 0,
});
const copied = (directions: ArmDirections): ArmDirections => {
  const copy = makeArmDirections();
  copyArmDirections(directions, copy);
  return copy;
};

/** The drawn arm, frame after frame, from the jump on; goalAt: where the arm belongs [s after the jump]. */
function drawn(from: ArmDirections, goalAt: (time: number) => ArmDirections, rateHz: number, seconds: number) {
  const transition = makeArmTransition();
  const now = copied(from);
  startTransition(transition, now, wantedOf(goalAt(0)));
  const arms = [copied(now)];
  let duration = Number.NaN;
  for (let i = 1; i <= Math.ceil(seconds * rateHz - 1e-9); i++) {
    followTransition(transition, wantedOf(goalAt(i / rateHz)), now, 1 / rateHz);
    arms.push(copied(now));
    if (Number.isNaN(duration) && Number.isNaN(transition.age)) duration = i / rateHz;
  }
  return { arms, duration };
}

const angle = (a: Vec3, b: Vec3): number => 2 * Math.asin(Math.min(1, distance(a, b) / 2));
const turned = (by: number, { upperArm, forearm, hinge }: ArmDirections): ArmDirections => {
  const turn = fromAxisAngle(up, by);
  return { upperArm: rotate(turn, upperArm), forearm: rotate(turn, forearm), hinge: rotate(turn, hinge) };
};

describe('an arm whose hand has jumped', () => {
  test('sets out from where it was drawn, and is at its goal when the transition ends', () => {
    fc.assert(
      fc.property(arm, arm, (from, wanted) => {
        const transition = makeArmTransition();
        const now = copied(from);
        startTransition(transition, now, wantedOf(wanted));
        followTransition(transition, wantedOf(wanted), now, 0);
        expect(distance(wristOf(now), wristOf(from))).toBeLessThan(1e-6);
        expect(distance(elbowOf(now), elbowOf(from))).toBeLessThan(1e-6);
        for (let i = 0; i < 54; i++) followTransition(transition, wantedOf(wanted), now, 1 / 60);
        expect(now).toEqual(copied(wanted));
        expect(transition.age).toBeNaN();
      }),
      { seed },
    );
  });

  test('takes 0.2 to 0.9 s, with elbow and wrist below 2.25 m/s where that suffices', {
    tags: ['full'],
  }, () => {
    fc.assert(
      fc.property(arm, arm, (from, wanted) => {
        const rateHz = 240;
        const { arms, duration } = drawn(from, () => wanted, rateHz, 2.5);
        expect(duration).toBeGreaterThanOrEqual(0.2 - 1e-9);
        expect(duration).toBeLessThanOrEqual(0.9 + 1e-9);
        const fastest = fastestOver(pathOf(arms)) + 1e-6;
        for (let i = 1; i < arms.length; i++) {
          expect(distance(wristOf(arms[i]!), wristOf(arms[i - 1]!)) * rateHz).toBeLessThan(fastest);
          expect(distance(elbowOf(arms[i]!), elbowOf(arms[i - 1]!)) * rateHz).toBeLessThan(fastest);
        }
        expect(arms.at(-1)).toEqual(copied(wanted));
      }),
      { seed },
    );
  });

  test('turns each bone by the shortest way, never back, to a direction that lies near', () => {
    fc.assert(
      fc.property(arm, arm, (from, wanted) => {
        fc.pre(Math.max(angle(from.upperArm, wanted.upperArm), angle(from.forearm, wanted.forearm)) < 2);
        const { arms } = drawn(from, () => wanted, 60, 1.5);
        for (const bone of ['upperArm', 'forearm'] as const) {
          let turned = 0;
          for (let i = 1; i < arms.length; i++) {
            const [now, before] = [arms[i]![bone], arms[i - 1]![bone]];
            expect(angle(now, wanted[bone])).toBeLessThan(angle(before, wanted[bone]) + 1e-6);
            turned += angle(now, before);
          }
          expect(turned).toBeCloseTo(angle(from[bone], wanted[bone]), 4);
        }
      }),
      { seed },
    );
  });

  test('swings by the outside where it has to turn round', () => {
    const straight = (upperArm: Vec3): ArmDirections => ({
      ...{ upperArm, forearm: upperArm },
      hinge: normalise(cross(upperArm, outside)),
    });
    fc.assert(
      fc.property(direction, (way) => {
        fc.pre(Math.abs(dot(way, outside)) < 0.9);
        const { arms } = drawn(straight(way), () => straight(scale(way, -1)), 60, 1.5);
        const halfWay = arms.filter(({ upperArm }) => Math.abs(dot(upperArm, way)) < 0.3);
        expect(halfWay.length).toBeGreaterThan(0);
        for (const { upperArm } of halfWay) expect(dot(upperArm, outside)).toBeGreaterThan(0);
      }),
      { seed },
    );
  });

  test('is in one place at 60, 72, 90 and 120 Hz, to a frame’s motion', () => {
    fc.assert(
      fc.property(arm, arm, (from, wanted) => {
        // Until it is there a frame's length of its way, at its speed, is between one rate and another.
        const fastest = fastestOver(pathOf(drawn(from, () => wanted, 60, 1).arms));
        const at60 = drawn(from, () => wanted, 60, 1 / 6).arms.at(-1)!;
        for (const rateHz of [72, 90, 120]) {
          const wrist = wristOf(drawn(from, () => wanted, rateHz, 1 / 6).arms.at(-1)!);
          expect(distance(wrist, wristOf(at60))).toBeLessThan(fastest / 60);
        }
      }),
      { seed },
    );
  });

  test('ends where it is wanted though that moves meanwhile, without a step', () => {
    fc.assert(
      fc.property(arm, arm, evenly(-2, 2), (from, wanted, turning) => {
        const goalAt = (time: number) => turned(turning * time, wanted);
        const { arms, duration } = drawn(from, goalAt, 60, 2.5);
        expect(distance(wristOf(arms.at(-1)!), wristOf(goalAt((arms.length - 1) / 60)))).toBeLessThan(1e-9);
        expect(duration).toBeLessThanOrEqual(0.9 + 1e-9);
        // What the hand goes in a frame, and the arm beyond that.
        const own = (bones.upper + bones.lower) * Math.abs(turning / 60);
        const fastest = fastestOver(pathOf(arms));
        for (let i = 1; i < arms.length; i++) {
          expect(distance(wristOf(arms[i]!), wristOf(arms[i - 1]!))).toBeLessThan(own + fastest / 60 + 1e-6);
        }
      }),
      { seed },
    );
  });

  test('moves its elbow no faster for a hand that moves about a still elbow', () => {
    fc.assert(
      fc.property(arm, arm, evenly(-12, 12), (from, wanted, turning) => {
        const goalAt = (time: number): ArmDirections => ({
          ...wanted,
          forearm: rotate(fromAxisAngle(wanted.hinge, turning * time), wanted.forearm),
        });
        const { arms, duration } = drawn(from, goalAt, 60, 2.5);
        expect(duration).toBeLessThanOrEqual(0.9 + 1e-9);
        const fastest = fastestOver(pathOf(arms));
        for (let i = 1; i < arms.length; i++)
          expect(distance(elbowOf(arms[i]!), elbowOf(arms[i - 1]!))).toBeLessThan(fastest / 60 + 1e-6);
      }),
      { seed },
    );
  });

  test('keeps bones and hinge unit vectors, and the hinge across the upper arm', () => {
    fc.assert(
      fc.property(arm, arm, (from, wanted) => {
        for (const { upperArm, forearm, hinge } of drawn(from, () => wanted, 60, 1).arms) {
          for (const each of [upperArm, forearm, hinge]) expect(length(each)).toBeCloseTo(1, 6);
          const normal = cross(upperArm, forearm);
          if (length(normal) > 0.3) expect(length(add(normalise(normal), hinge))).toBeGreaterThan(1);
        }
      }),
      { seed },
    );
  });

  test('bends about the normal of its bones, but where it is all but straight', () => {
    fc.assert(
      fc.property(arm, arm, (from, wanted) => {
        for (const { upperArm, forearm, hinge } of drawn(from, () => wanted, 60, 1).arms) {
          const normal = cross(upperArm, forearm);
          const isBent = length(normal) > 0.11 || dot(upperArm, forearm) < 0;
          if (isBent && length(normal) > 1e-6) expect(angle(hinge, normalise(normal))).toBeLessThan(1e-6);
        }
      }),
      { seed },
    );
  });

  test('without a jump an arm is as it is wanted', () => {
    const [transition, now] = [makeArmTransition(), makeArmDirections()];
    const wanted = { upperArm: vec3(0, -1, 0), forearm: vec3(0, 0, -1), hinge: vec3(1, 0, 0) };
    followTransition(transition, wantedOf(wanted), now, 1 / 60);
    expect(now).toEqual(copied(wanted));
  });
});
