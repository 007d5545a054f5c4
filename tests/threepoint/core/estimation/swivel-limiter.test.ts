import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { elbowCircle, makeElbowCircle } from '../../../../src/threepoint/core/body/two-bone-ik';
import {
  type EstimatedPole,
  estimatedPole,
  limitSwivel,
} from '../../../../src/threepoint/core/estimation/arms/swivel-limiter';
import { makeFitTorsoState } from '../../../../src/threepoint/core/estimation/trunk/fit-torso';
import { copyVec3, distance, down, normalise, scale, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import { number, seed } from '../arbitraries';

const bones = { upper: 0.28, lower: 0.26 };
const shoulder = vec3(0.18, 1.35, 0.05);
/** Well ahead of the trunk: its elbow is free to turn all the way round. */
const wrist = vec3(0.25, 1.35, -0.4);
const upright = makeFitTorsoState().pose;
copyVec3(vec3(0, 0.95, 0.05), upright.hips);
copyVec3(vec3(0, 1.2, 0.05), upright.chest);
copyVec3(vec3(0, 1.42, 0.05), upright.neck);
const circle = elbowCircle(shoulder, wrist, bones, down, makeElbowCircle());

const poleTowards = (elbow: Vec3): EstimatedPole =>
  estimatedPole({ shoulder, elbow, wrist }, circle, [down, vec3(0, 0, 1)], {
    direction: vec3(0, 0, 0),
    confidence: Number.NaN,
  });
const angle = (a: Vec3, b: Vec3): number => 2 * Math.asin(Math.min(1, distance(a, b) / 2));

/** Returns the elbow's direction in each frame when its estimate jumps from one side to the other. */
function turning(from: Vec3, to: EstimatedPole, confidence: number, rateHz: number, seconds: number): Vec3[] {
  const limits = { side: 'right', torso: upright, armLength: 0.54, confidence } as const;
  let pole = limitSwivel(null, poleTowards(from), circle, { ...limits, deltaSeconds: 0 }, vec3(0, 0, 0));
  const poles = [pole];
  for (let i = 0; i < seconds * rateHz; i++) {
    const before = { axis: copyVec3(circle.axis), pole: copyVec3(pole) };
    pole = limitSwivel(before, to, circle, { ...limits, deltaSeconds: 1 / rateHz }, vec3(0, 0, 0));
    poles.push(pole);
  }
  return poles;
}

const below = vec3(0.22, 1.1, -0.15);
const above = vec3(0.22, 1.55, -0.15);
const beside = vec3(0.5, 1.35, -0.1);

describe('an elbow whose estimate jumps', () => {
  test('starts on its estimate and gets to the other side', () => {
    const poles = turning(below, poleTowards(beside), 1, 60, 0.5);
    expect(angle(poles[0]!, poleTowards(below).direction)).toBeLessThan(1e-6);
    expect(angle(poles.at(-1)!, poleTowards(beside).direction)).toBeLessThan(1e-6);
  });

  test.each([60, 72, 120])('turns at 12 rad/s at most, at %s Hz', (rateHz) => {
    const poles = turning(below, poleTowards(above), 1, rateHz, 0.6);
    for (let i = 1; i < poles.length; i++) expect(angle(poles[i]!, poles[i - 1]!)).toBeLessThan(12.001 / rateHz);
  });

  test('turns slower, at 5 rad/s, where the hand is a guess', () => {
    const poles = turning(below, poleTowards(above), 0, 60, 0.3);
    for (let i = 1; i < poles.length; i++) expect(angle(poles[i]!, poles[i - 1]!)).toBeLessThan(5.001 / 60);
    expect(angle(poles.at(-1)!, poles[0]!)).toBeGreaterThan(1);
  });

  test('goes slowly, a fifth of the way in 0.1 s, after estimates near the arm’s line', () => {
    fc.assert(
      fc.property(number(0, 0.004), (aside) => {
        const middle = vec3(0.215, 1.35 + aside, -0.175);
        const poles = turning(below, poleTowards(middle), 1, 60, 0.1);
        expect(angle(poles.at(-1)!, poles[0]!)).toBeLessThan(0.2 * Math.PI);
      }),
      { seed },
    );
  });

  test('stays a unit vector across the arm’s line', () => {
    for (const pole of turning(below, poleTowards(above), 1, 60, 0.5)) {
      expect(distance(pole, normalise(scale(pole, 2)))).toBeLessThan(1e-9);
      const { x, y, z } = circle.axis;
      expect(Math.abs(pole.x * x + pole.y * y + pole.z * z)).toBeLessThan(1e-9);
    }
  });
});
