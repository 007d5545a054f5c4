import { add, rotate, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { mannequinLegs } from '../../bench/evaluate/legs/leg-drivers';
import { addLegs, emptyLegMeasures, legReport } from '../../bench/evaluate/legs/leg-measures';
import { contactsOf, footHeights, type TrueLeg, type TrueLegs } from '../../bench/evaluate/legs/leg-truth';
import { createLegs, proportions, standing, walking } from '../threepoint/avatar/walking-person';

type LegPose = ReturnType<typeof createLegs>['legs']['left'];
type Points = ReturnType<typeof standing>;

const rateHz = 60;
/** Stands for two seconds; another time walks for four. */
const stood = Array.from({ length: 120 }, (_, row) => standing(row / rateHz));
const walked = Array.from({ length: 240 }, (_, row) => walking(row / rateHz));

const copyOf = ({ hip, knee, ankle, foot }: LegPose): TrueLeg => ({
  hip: { ...hip },
  knee: { ...knee },
  ankle: { ...ankle },
  ball: add(ankle, rotate(foot, vec3(0, -0.68 * 0.08, -1.58 * 0.08))),
});

/** What a person would do whose legs are the page's. */
function legsUnder(body: readonly Points[]): TrueLegs[] {
  const posture = createLegs();
  return body.map((points, row) => {
    posture.update(points, row === 0 ? 0 : 1 / rateHz);
    return { hips: points.hips, left: copyOf(posture.legs.left), right: copyOf(posture.legs.right) };
  });
}

/** The legs drawn under `body` against those that truly are under `person`. */
function reportOf(person: readonly Points[], body: readonly Points[]) {
  const truth = legsUnder(person);
  const contacts = contactsOf(truth, footHeights([truth]), rateHz);
  const measures = emptyLegMeasures();
  addLegs(measures, { truth, contacts, body, rateHz }, createLegs(), proportions);
  return legReport(measures);
}

const movedBy = (body: readonly Points[], x: number, y: number): Points[] =>
  body.map((points) => {
    const { position, orientation } = points.hips;
    return { ...points, hips: { position: vec3(position.x + x, position.y + y, position.z), orientation } };
  });

test.each([
  ['stands', stood],
  ['walks', walked],
])('legs that are the truth of a person who %s have no errors and its skating', (_, body) => {
  const report = reportOf(body, body);
  expect([report.pelvisCm, report.kneeCm, report.footCm]).toEqual([0, 0, 0]);
  expect(report.skateCmS).toBe(report.trueSkateCmS);
  expect(report.sinkCm).toBeLessThan(0.1);
});

test('feet stand while a person stands, and in turns while they walk', () => {
  const contacts = [stood, walked].map((body) => {
    const truth = legsUnder(body);
    return contactsOf(truth, footHeights([truth]), rateHz);
  });
  expect(contacts[0]!.every(({ left, right }) => left && right)).toBe(true);
  const walking = contacts[1]!.slice(60);
  for (const side of ['left', 'right'] as const) {
    const share = walking.filter((contact) => contact[side]).length / walking.length;
    expect(share).toBeGreaterThan(0.1);
    expect(share).toBeLessThan(0.9);
  }
});

test('hips that are drawn 5 cm aside are measured as 5 cm', () => {
  expect(reportOf(stood, movedBy(stood, 0.05, 0)).pelvisCm).toBeCloseTo(5, 1);
});

test('legs too short for their hips float', () => {
  const report = reportOf(stood, movedBy(stood, 0, 0.1));
  expect(report.floatCm).toBeGreaterThan(3);
  expect(reportOf(stood, stood).floatCm).toBeLessThan(1);
});

test('the mannequin’s legs reach the floor from the hips of a calibrated body', async () => {
  const legsOf = await mannequinLegs();
  for (const eyeHeight of [1.4, 1.6, 1.8]) {
    const { hipOffset, upper, lower, ankleHeight } = legsOf({ eyeHeight, armSpan: 1.5 });
    expect(upper + lower + ankleHeight - hipOffset.y).toBeCloseTo(0.62155 * eyeHeight, 1);
  }
});
