import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { elbowCircle, elbowOnCircle, makeElbowCircle } from '../../../../src/threepoint/core/body/two-bone-ik';
import {
  type EstimatedPole,
  elbowSpeed,
  estimatedPole,
  limitSwivel,
} from '../../../../src/threepoint/core/estimation/arms/swivel-limiter';
import { makeFitTorsoState } from '../../../../src/threepoint/core/estimation/trunk/fit-torso';
import {
  copyVec3,
  distance,
  down,
  normalise,
  scale,
  subtract,
  type Vec3,
  vec3,
} from '../../../../src/threepoint/core/math/vec3';
import { number, seed } from '../arbitraries';

const bones = { upper: 0.28, lower: 0.26 };
const shoulder = vec3(0.18, 1.35, 0.05);
/** Well ahead of the trunk: its elbow is free to turn all the way round. */
const wrist = vec3(0.25, 1.35, -0.4);
const upright = makeFitTorsoState().pose;
copyVec3(vec3(0, 0.95, 0.05), upright.hips);
copyVec3(vec3(0, 1.2, 0.05), upright.chest);
copyVec3(vec3(0, 1.42, 0.05), upright.neck);
const headJoint = vec3(0, 1.5, 0);

const circleTo = (hand: Vec3) => elbowCircle(shoulder, hand, bones, down, makeElbowCircle());
const circle = circleTo(wrist);

const poleTowards = (elbow: Vec3, hand = wrist): EstimatedPole =>
  estimatedPole({ shoulder, elbow, wrist: hand }, circleTo(hand), [down, vec3(0, 0, 1)], {
    direction: vec3(0, 0, 0),
    confidence: Number.NaN,
  });
const angle = (a: Vec3, b: Vec3): number => 2 * Math.asin(Math.min(1, distance(a, b) / 2));

interface Turning {
  readonly confidence?: number;
  readonly rateHz?: number;
  readonly seconds: number;
  readonly hand?: Vec3;
}

/** Returns the elbow's direction in each frame when its estimate jumps from one side to the other. */
function turning(from: Vec3, to: Vec3, { confidence = 1, rateHz = 60, seconds, hand = wrist }: Turning): Vec3[] {
  const longestStep = elbowSpeed / rateHz;
  const context = { side: 'right', torso: upright, headJoint, longestStep, armLength: 0.54, confidence } as const;
  const own = circleTo(hand);
  let pole = limitSwivel(null, poleTowards(from, hand), own, { ...context, deltaSeconds: 0 }, vec3(0, 0, 0));
  const poles = [pole];
  for (let i = 0; i < seconds * rateHz; i++) {
    const before = {
      axis: copyVec3(own.axis),
      pole: copyVec3(pole),
      elbow: subtract(elbowOnCircle(own, pole), headJoint),
      wrist: subtract(hand, headJoint),
    };
    const deltaSeconds = 1 / rateHz;
    pole = limitSwivel(before, poleTowards(to, hand), own, { ...context, deltaSeconds }, vec3(0, 0, 0));
    poles.push(pole);
  }
  return poles;
}

const below = vec3(0.22, 1.1, -0.15);
const above = vec3(0.22, 1.55, -0.15);
const beside = vec3(0.5, 1.35, -0.1);

describe('an elbow whose estimate jumps', () => {
  test('starts on its estimate and gets to the other side', () => {
    const poles = turning(below, beside, { seconds: 0.5 });
    expect(angle(poles[0]!, poleTowards(below).direction)).toBeLessThan(1e-6);
    expect(angle(poles.at(-1)!, poleTowards(beside).direction)).toBeLessThan(1e-6);
  });

  test.each([60, 72, 120])('turns at 12 rad/s at most, at %s Hz', (rateHz) => {
    const poles = turning(below, above, { rateHz, seconds: 0.6 });
    for (let i = 1; i < poles.length; i++) expect(angle(poles[i]!, poles[i - 1]!)).toBeLessThan(12.001 / rateHz);
  });

  test('moves at 2 m/s at most while its hand rests near the shoulder', () => {
    const hand = vec3(0.22, 1.4, -0.12);
    const steps = turning(below, above, { seconds: 0.6, hand }).map((pole) => elbowOnCircle(circleTo(hand), pole));
    const longest = Math.max(...steps.slice(1).map((elbow, i) => distance(elbow, steps[i]!)));
    expect(longest).toBeLessThan(2.001 / 60);
    expect(longest).toBeGreaterThan(1.9 / 60);
  });

  test('turns slower, at 5 rad/s, where the hand is a guess', () => {
    const poles = turning(below, above, { confidence: 0, seconds: 0.3 });
    for (let i = 1; i < poles.length; i++) expect(angle(poles[i]!, poles[i - 1]!)).toBeLessThan(5.001 / 60);
    expect(angle(poles.at(-1)!, poles[0]!)).toBeGreaterThan(1);
  });

  test('goes slowly, a fifth of the way in 0.1 s, after estimates near the arm’s line', () => {
    fc.assert(
      fc.property(number(0, 0.004), (aside) => {
        const middle = vec3(0.215, 1.35 + aside, -0.175);
        const poles = turning(below, middle, { seconds: 0.1 });
        expect(angle(poles.at(-1)!, poles[0]!)).toBeLessThan(0.2 * Math.PI);
      }),
      { seed },
    );
  });

  test('stays a unit vector across the arm’s line', () => {
    for (const pole of turning(below, above, { seconds: 0.5 })) {
      expect(distance(pole, normalise(scale(pole, 2)))).toBeLessThan(1e-9);
      const { x, y, z } = circle.axis;
      expect(Math.abs(pole.x * x + pole.y * y + pole.z * z)).toBeLessThan(1e-9);
    }
  });
});
