import * as fc from 'fast-check';
import {
  createNormalRandom,
  createRandom,
  fromAxisAngle,
  length,
  multiply,
  normalise,
  type Pose,
  type Quat,
  vec3,
} from 'threepoint/math';
import { expect, test } from 'vitest';
import { type NoiseFigures, TrackerNoise } from '../../../src/page/check/tracker-noise';

/** A tracker that is held for 15 s: white noise by axis, and slow movement. */
interface Held {
  readonly rateHz: number;
  readonly mm: number;
  readonly degrees: number;
  /** The amplitude of the sway [m], and of the turn with it [rad]; its frequency [Hz]. */
  readonly sway?: number;
  readonly turn?: number;
  readonly swayHz?: number;
  /** The share of the noise that the device carries over to the next frame. */
  readonly smoothing?: number;
  readonly seed?: number;
  /** Frames that are missing, or poses that are elsewhere. */
  readonly skip?: (row: number) => boolean;
  readonly move?: (time: number) => number;
}

const start = fromAxisAngle(normalise(vec3(1, 2, -1)), 2.1);

function poseOf(held: Held, time: number, noise: readonly number[]): Pose<'floor'> {
  const { sway = 0, turn = 0, swayHz = 0.4, move = () => 0 } = held;
  const phase = 2 * Math.PI * swayHz * time;
  const by = vec3(noise[3]!, noise[4]!, noise[5]!);
  const turned = multiply(fromAxisAngle(normalise(vec3(0.2, 1, 0.1)), turn * Math.sin(phase)), start);
  const orientation: Quat = multiply(turned, fromAxisAngle(normalise(by), length(by)));
  const position = vec3(
    0.3 + sway * Math.sin(phase) + noise[0]! + move(time),
    1.6 + 0.3 * sway * Math.cos(0.7 * phase) + noise[1]!,
    -2 + noise[2]!,
  );
  return { position, orientation };
}

function figuresOf(held: Held): NoiseFigures | null {
  const { rateHz, mm, degrees, smoothing = 0, seed = 7, skip = () => false } = held;
  const normal = createNormalRandom(seed);
  const recorder = new TrackerNoise();
  const sizes = [mm, mm, mm]
    .map((each) => each / 1000)
    .concat([degrees, degrees, degrees].map((d) => (d * Math.PI) / 180));
  let noise = sizes.map((size) => size * normal());
  for (let row = 0; row < 15 * rateHz; row++) {
    const fresh = sizes.map((size) => size * normal());
    // A first-order filter keeps the variance of its input by this factor.
    noise = fresh.map((value, i) => smoothing * noise[i]! + Math.sqrt(1 - smoothing ** 2) * value);
    if (!skip(row)) recorder.add(row / rateHz, poseOf(held, row / rateHz, noise));
  }
  return recorder.figures();
}

test('white noise in is the same figure out, at every rate, from any orientation', () => {
  fc.assert(
    fc.property(
      fc.constantFrom(60, 72, 90, 120),
      fc.double({ min: 0.01, max: 2, noNaN: true }),
      fc.double({ min: 0.005, max: 0.5, noNaN: true }),
      fc.integer(),
      (rateHz, mm, degrees, seed) => {
        const { positionMm, rotationDegrees, frames } = figuresOf({ rateHz, mm, degrees, seed })!;
        expect(frames).toBe(15 * rateHz);
        for (const level of [positionMm.frame, positionMm.slow]) expect(Math.abs(level / mm - 1)).toBeLessThan(0.08);
        for (const level of [rotationDegrees.frame, rotationDegrees.slow])
          expect(Math.abs(level / degrees - 1)).toBeLessThan(0.08);
      },
    ),
    { numRuns: 12 },
  );
});

test('a person who sways by 1 cm and turns by 2° adds sway, not noise', () => {
  const held = { rateHz: 72, mm: 0.1, degrees: 0.03, sway: 0.01, turn: 0.035 };
  const { positionMm, rotationDegrees } = figuresOf(held)!;
  expect(Math.abs(positionMm.frame / 0.1 - 1)).toBeLessThan(0.05);
  expect(Math.abs(rotationDegrees.frame / 0.03 - 1)).toBeLessThan(0.05);
  // Two axes sway with 10 and 3 mm: their root mean square over three axes.
  expect(positionMm.sway).toBeGreaterThan(3.5);
  expect(positionMm.sway).toBeLessThan(5);
  expect(rotationDegrees.sway).toBeGreaterThan(0.6);
});

test('sway without noise adds what the documentation states', () => {
  const { positionMm } = figuresOf({ rateHz: 72, mm: 0, degrees: 0, sway: 0.01, swayHz: 0.5 })!;
  const alone = (10 * (2 * Math.PI * 0.5 * (1 / 72)) ** 2) / Math.sqrt(12);
  // One axis sways with 10 mm and another with 3 mm more slowly; three axes share the mean.
  expect(positionMm.frame).toBeGreaterThan(alone * 0.5);
  expect(positionMm.frame).toBeLessThan(alone * 0.65);
});

test('noise that the device smooths is larger at a 0.1 s lag than between frames', () => {
  const { positionMm } = figuresOf({ rateHz: 72, mm: 0.5, degrees: 0.1, smoothing: 0.8 })!;
  expect(positionMm.frame).toBeLessThan(0.25);
  expect(positionMm.slow).toBeGreaterThan(0.35);
});

test('a glance aside, dropped frames and a pause change nothing', () => {
  const random = createRandom(3);
  const held = { rateHz: 72, mm: 0.2, degrees: 0.05 };
  const disturbed = figuresOf({
    ...held,
    skip: (row) => random() < 0.03 || (row > 500 && row < 600),
    move: (time) => (time > 3 && time < 5 ? 0.1 * Math.sin(20 * (time - 3)) : 0),
  })!;
  const still = figuresOf(held)!;
  expect(Math.abs(disturbed.positionMm.frame / still.positionMm.frame - 1)).toBeLessThan(0.1);
  expect(Math.abs(disturbed.rotationDegrees.slow / still.rotationDegrees.slow - 1)).toBeLessThan(0.15);
});

test('a device that does not move at all has no noise and repeats itself', () => {
  const { positionMm, rotationDegrees, repeated } = figuresOf({ rateHz: 90, mm: 0, degrees: 0 })!;
  expect(positionMm).toEqual({ frame: 0, slow: 0, sway: expect.closeTo(0, 6) });
  expect(rotationDegrees.frame).toBeCloseTo(0, 6);
  expect(repeated).toBe(1);
});

test('fewer than two seconds give no figure', () => {
  const recorder = new TrackerNoise();
  expect([recorder.figures(), recorder.moved]).toEqual([null, false]);
  recorder.add(0, { position: vec3(0, 1, 0), orientation: start });
  expect([recorder.figures(), recorder.moved]).toEqual([null, false]);
  for (let row = 1; row < 100; row++) recorder.add(row / 72, { position: vec3(0, 1, 0), orientation: start });
  expect(recorder.figures()).toBeNull();
});

test('a tracker that moves or turns for most of the time is not at rest', () => {
  const held = { rateHz: 72, mm: 0.2, degrees: 0.05 };
  expect(figuresOf({ ...held, move: (time) => 0.2 * Math.sin(3 * time) })).toBeNull();
  expect(figuresOf({ ...held, turn: 0.5, swayHz: 1 })).toBeNull();
  expect(figuresOf({ ...held, mm: 2, degrees: 0.5 })).not.toBeNull();
});
