import { distance } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { createDriver, drive } from '../../bench/evaluate/drive';
import {
  addPiece,
  compareTables,
  emptyGoldenTally,
  goldenFigures,
  worse,
} from '../../bench/evaluate/golden/golden-figures';
import { planGoldens } from '../../bench/evaluate/golden/golden-plan';
import type { MeasuredFrame } from '../../bench/evaluate/measures';
import { type Piece, type Staged, situations, undisturbed } from '../../bench/evaluate/situations';
import { person, recordedMotion } from './recorded-motion';

const rateHz = 60;
const piece: Piece = { name: 'generated', calibration: person, frames: recordedMotion(31, 600) };
const staged = (situation: string) => situations[situation]!(piece, rateHz, 0);
const still = () => undisturbed(piece, rateHz, 0);
const driveIk = ({ calibration, frames }: Staged) => drive('ik', calibration, null, frames);

/** Returns the figures of one driven piece. */
function figuresOf(staged: Staged, driven: readonly MeasuredFrame[], seen: readonly MeasuredFrame[] | null = null) {
  const tally = emptyGoldenTally();
  addPiece(tally, { name: 'generated', recordedHz: rateHz, staged, driven, seen });
  return goldenFigures(tally);
}

describe('a situation of the goldens', () => {
  test('a recentred wearer is drawn where nothing was recentred, once the filters have settled', async () => {
    const of = staged('recentred');
    const [recentred, before] = [await driveIk(of), await driveIk(still())];
    const resets = of.frames.flatMap(({ reset }, row) => (reset ? [row] : []));
    expect(resets.length).toBeGreaterThanOrEqual(1);
    const later = resets[0]! + 120;
    expect(distance(of.frames[later]!.frame.head.position, piece.frames[later]!.frame.head.position)).toBeGreaterThan(
      0.1,
    );
    for (const joint of ['hips', 'leftLowerArm', 'rightHand']) {
      expect(distance(recentred[later]!.joints[joint]!, before[later]!.joints[joint]!)).toBeLessThan(0.01);
    }
  });

  test('a pause has frames missing, and frames without hands while the device shows its menu', () => {
    const { frames } = staged('paused');
    const gaps = frames.flatMap(({ frame, resumes }, row) =>
      resumes ? [frame.time - frames[row - 1]!.frame.time] : [],
    );
    expect(Math.min(...gaps)).toBeGreaterThan(0.2);
    const menu = frames.filter(({ frame }) => frame.suspended);
    expect(menu.length).toBeGreaterThan(30);
    expect(menu.every(({ frame }) => frame.leftHand === null && frame.rightHand === null)).toBe(true);
  });

  test('a tilted headset that the calibration knows changes nothing', async () => {
    const [tilted, before] = [await driveIk(staged('headset tilted 12°')), await driveIk(still())];
    expect(distance(tilted[300]!.joints.hips!, before[300]!.joints.hips!)).toBeLessThan(1e-6);
  });

  test('figures have no holes in any situation', { tags: ['full'] }, async () => {
    const short = { ...piece, frames: piece.frames.slice(0, 270) };
    const before = await driveIk(undisturbed(short, rateHz, 0));
    for (const [situation, stage] of Object.entries(situations)) {
      const of = stage(short, rateHz, 0);
      const driven = await driveIk(of);
      const { figures, places } = figuresOf(of, driven, of.losses.length > 0 ? before : null);
      expect(
        Object.entries(figures).filter(([, value]) => !Number.isFinite(value)),
        situation,
      ).toEqual([]);
      expect(figures.frames, situation).toBe(driven.length);
      expect(places.stepCm, situation).toMatch(/^generated, \d+\.\d\d s, \w+$/);
    }
  });
});

test('a joint moved by 40 cm is the largest step, with its clip and second', async () => {
  const of = still();
  const driven = (await driveIk(of)).map((frame, row) => {
    const { chest } = frame.joints;
    return row < 200 ? frame : { ...frame, joints: { ...frame.joints, chest: { ...chest!, y: chest!.y + 0.4 } } };
  });
  const { figures, places } = figuresOf(of, driven);
  expect(figures.excessCm).toBeGreaterThan(35);
  expect(places.excessCm).toBe('generated, 3.33 s, chest');
});

describe('comparing with what was frozen', () => {
  test.each([
    ['mpjpeMeanCm', 6, 6.05, false],
    ['mpjpeMeanCm', 6, 6.07, true],
    ['mpjpeMeanCm', 6, 4, false],
    ['jerkRatio', 1.05, 1.051, false],
    ['jerkRatio', 1.05, 1.07, true],
    ['returnExcessCm', 4.9, 4.95, true],
    ['stepP999Cm', 4.9, 4.95, true],
    ['lossesOver5Cm', 0, 1, true],
    ['frames', 100, 99, true],
    ['handErrorMaxMm', 0, 1, true],
  ])('%s: %d and now %d', (figure, frozen, now, expected) => {
    expect(worse(figure, frozen, now)).toBe(expected);
  });

  test('a row or figure that is missing is worse', () => {
    const frozen = { ik: { jerkRatio: 1, stepCm: 3 }, learned: { jerkRatio: 1 } };
    const lacking = compareTables(frozen, { ik: { jerkRatio: 1 } }).filter((difference) => difference.worse);
    expect(lacking.map(({ row, figure }) => `${row} ${figure}`)).toEqual(['ik stepCm', 'learned jerkRatio']);
  });
});

test('the plan lets every estimator meet every situation, on people held out first of all', () => {
  const people = ['006', '007', '901', '005'];
  const clips = people.flatMap((name, person) =>
    Array.from({ length: 9 }, (_, number) => ({
      name: `${name}_${number}`,
      person: name,
      file: `${person}${number}.f32`,
      frames: 400 + 100 * number,
    })),
  );
  const index = { version: 1 as const, rateHz, corpusHash: '', columns: [], people: {}, clips, problems: [] };
  const jobs = planGoldens(index, new Set(['005']), 'full');
  expect(new Set(jobs.map(({ row }) => row)).size).toBe(jobs.length);
  for (const method of ['ik', 'paper', 'learned']) {
    for (const situation of Object.keys(situations)) {
      expect(jobs.some((job) => job.method === method && job.situation === situation)).toBe(true);
    }
  }
  const heldOut = jobs.find(({ row }) => row === 'learned · people held out')!;
  expect(new Set(heldOut.pieces.map(({ clip }) => clip.person))).toEqual(new Set(['006', '007']));
  expect(Math.max(...heldOut.pieces.map(({ frames }) => frames))).toBeLessThanOrEqual(15 * rateHz);
});

test('a driver forgets the past when the page does', async () => {
  const frames = piece.frames.slice(0, 60).map(({ frame }) => frame);
  const [fresh, used] = [createDriver('ik', person, null), createDriver('ik', person, null)];
  // Visible hands would change its estimate of their tilt.
  for (const frame of frames) await used.draw({ ...frame, leftHand: null, rightHand: null });
  used.reset();
  const later = piece.frames[300]!.frame;
  expect((await used.draw(later)).joints).toEqual((await fresh.draw(later)).joints);
});
