import * as fc from 'fast-check';
import { ValidationError } from 'threepoint/core';
import { expect, test } from 'vitest';
import { readHeadsetReport, writeHeadsetReport } from '../../../src/page/check/headset-report';
import { anyReport } from './any-report';

test('a written report is read again, to four digits', () => {
  fc.assert(
    fc.property(anyReport, (report) => {
      const read = readHeadsetReport(writeHeadsetReport(report));
      expect(read.noise.map(({ tracker }) => tracker)).toEqual(report.noise.map(({ tracker }) => tracker));
      read.noise.forEach(({ positionMm }, index) => {
        const { frame } = report.noise[index]!.positionMm;
        expect(Math.abs(positionMm.frame - frame)).toBeLessThanOrEqual(5e-4 * frame);
      });
      // Rounding once is rounding for good: the text of what was read is the same.
      expect(writeHeadsetReport(read)).toBe(writeHeadsetReport(report));
    }),
  );
});

/** A place in a file: the keys that lead to it. */
type Way = readonly (string | number)[];

/** Every place in a value that holds no object and no list. */
function leavesOf(value: unknown, way: Way = []): Way[] {
  if (typeof value !== 'object' || value === null) return [way];
  return Object.entries(value).flatMap(([key, inner]) =>
    leavesOf(inner, [...way, Array.isArray(value) ? Number(key) : key]),
  );
}

/** Returns a copy with this value at this place; undefined removes it. */
function withValue(source: unknown, way: Way, value: unknown): unknown {
  const copy = JSON.parse(JSON.stringify(source));
  let at = copy;
  for (const key of way.slice(0, -1)) at = at[key];
  at[way.at(-1)!] = value;
  return copy;
}

const fieldOf = (way: Way): string =>
  way.reduce<string>(
    (field, key) => (typeof key === 'number' ? `${field}[${key}]` : field ? `${field}.${key}` : key),
    '',
  );

function refusal(value: unknown): ValidationError {
  try {
    readHeadsetReport(typeof value === 'string' ? value : JSON.stringify(value));
  } catch (error) {
    if (error instanceof ValidationError) return error;
    throw error;
  }
  throw new Error('the file was accepted');
}

test('a wrong value anywhere is refused, and the message names its place', () => {
  const wrong = [{ not: 'expected' }, -1e12, undefined];
  fc.assert(
    fc.property(anyReport, fc.nat(), fc.constantFrom(...wrong), (report, number, value) => {
      const written = JSON.parse(writeHeadsetReport(report));
      const leaves = leavesOf(written);
      const way = leaves[number % leaves.length]!;
      // An element that is missing from a list becomes null in JSON.
      const { field, complaint } = refusal(withValue(written, way, value));
      // An object in place of null is refused for a field of its own.
      const [given, place] = [`${fieldOf(way)}.`, `${field}.`];
      expect(given.startsWith(place) || place.startsWith(given), `${field} of ${fieldOf(way)}`).toBe(true);
      expect(complaint).not.toBe('');
    }),
    { numRuns: 300 },
  );
});

test('an unknown field, a repeated tracker and what contradicts itself are refused in a sentence', () => {
  const [sample] = fc.sample(
    anyReport.filter((report) => report.noise.length > 0 && report.frameTimes.length > 0 && report.losses.length > 0),
    { numRuns: 1, seed: 4 },
  );
  const written = JSON.parse(writeHeadsetReport(sample!));
  expect(refusal({ ...written, poses: [] }).message).toBe('poses: is not known here');
  expect(refusal({ ...written, version: 1 }).message).toBe('version: expected 2: this program reads no other version');
  expect(refusal({ ...written, format: 'x' }).message).toBe('format: expected "threepoint-headset-check"');
  expect(refusal({ ...written, noise: [written.noise[0], written.noise[0]] }).message).toBe(
    'noise: expected each tracker once',
  );
  const [row] = written.frameTimes;
  expect(refusal({ ...written, frameTimes: [{ ...row, missed: row.work.frames + 1 }] }).message).toBe(
    'frameTimes[0]: expected no more missed frames than frames',
  );
  const [hand] = written.losses;
  expect(refusal({ ...written, losses: [{ ...hand, lengthsMs: [20, 10] }] }).message).toBe(
    'losses[0].lengthsMs: expected ascending lengths',
  );
  expect(refusal({ ...written, bodyTracking: { frames: 3, complaint: null, joints: null } }).message).toBe(
    'bodyTracking: expected joints where frames were compared',
  );
});

test('a text that is no report is refused in a sentence', () => {
  expect(refusal('{').message).toMatch(/^is no JSON \(/);
  expect(refusal('7').message).toBe('expected an object');
  expect(refusal(' '.repeat(2_000_000)).message).toBe('expected at most 1000000 characters');
});
