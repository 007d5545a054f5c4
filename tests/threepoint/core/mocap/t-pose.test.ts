import { describe, expect, test } from 'vitest';
import {
  angleBetween,
  fromAxisAngle,
  multiply,
  type Quat,
  quat,
  rotate,
} from '../../../../src/threepoint/core/math/quat';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import { dot, forward, right, up } from '../../../../src/threepoint/core/math/vec3';
import { prepareMocap } from '../../../../src/threepoint/core/mocap/prepare-mocap';
import { trackedWidth } from '../../../../src/threepoint/core/mocap/simulate-trackers';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { madeBvh, walkingAnglesAt } from './made-bvh';
import { motionOf, type RerolledOptions, rerolledBvh } from './rerolled';

const prepare = (text: string) => finishWork(prepareMocap({ format: 'bvh', name: 'someone_walks.bvh', text }));

const walk = { anglesAt: walkingAnglesAt, speed: 130, frames: 240 };

const turnAt = (from: Float32Array, at: number): Quat => {
  const [x, y, z, w] = from.subarray(at, at + 4);
  return quat(x!, y!, z!, w!);
};

/** Compares a motion with the same one whose joints have other local frames. */
function compared(plainText: string, options: RerolledOptions) {
  const rolled = prepare(rerolledBvh(motionOf(plainText), options));
  const [a, b] = [prepare(plainText).clips[0]!, rolled.clips[0]!];
  expect(b.frameCount).toBe(a.frameCount);
  let [furthest, cosine, hands] = [0, 1, 0];
  for (const [i, value] of a.truth.entries())
    if (Number.isFinite(value)) furthest = Math.max(furthest, 1000 * Math.abs(value - b.truth[i]!));
  for (let at = 0; at < a.tracked.length; at += trackedWidth) {
    const ways = [a, b].map(({ tracked }) => rotate(turnAt(tracked, at + 3), forward));
    cosine = Math.min(cosine, dot(ways[0]!, ways[1]!));
    for (const hand of [10, 17])
      hands = Math.max(hands, angleBetween(turnAt(a.tracked, at + hand), turnAt(b.tracked, at + hand)));
  }
  const taller = Math.abs(b.calibration.eyeHeight - a.calibration.eyeHeight);
  return {
    furthest,
    cosine,
    hands: (hands * 180) / Math.PI,
    taller,
    notes: rolled.notes.join(),
    doubts: rolled.doubts,
  };
}

/** Returns a rotation for every joint, drawn from a seed: any one, or by right angles. */
function rolls(seed: number, by: 'any angles' | 'right angles'): (name: string) => Quat {
  const random = createRandom(seed);
  const drawn = new Map<string, Quat>();
  const angle = () => (by === 'any angles' ? 2 * Math.PI * random() : (Math.PI / 2) * Math.floor(4 * random()));
  const draw = () =>
    multiply(fromAxisAngle(up, angle()), multiply(fromAxisAngle(right, angle()), fromAxisAngle(up, angle())));
  return (name) => drawn.get(name) ?? drawn.set(name, draw()).get(name)!;
}

const zUp = fromAxisAngle(right, Math.PI / 2);
const swap = (word: string): string => (word === 'Left' ? 'Right' : 'Left');
const seeds = Array.from({ length: 8 }, (_, seed) => seed);

describe('a walk is read as with its T-pose at rest where', () => {
  const plain = madeBvh(walk);

  test.each(seeds)('all joints have frames of right angles, seed %i', (seed) => {
    const { furthest, cosine, hands, taller, doubts } = compared(plain, { rollOf: rolls(seed, 'right angles') });
    expect(furthest).toBeLessThan(0.1);
    expect(cosine).toBeGreaterThan(0.9999);
    expect(hands).toBeLessThan(0.1);
    expect(taller).toBeLessThan(0.001);
    expect(doubts).toEqual([]);
  });

  test.each(seeds)('all joints have any frames, seed %i', (seed) => {
    const { furthest, cosine, hands, taller, notes } = compared(plain, { rollOf: rolls(seed, 'any angles') });
    expect(furthest).toBeLessThan(0.1);
    expect(cosine).toBeGreaterThan(0.99);
    expect(hands).toBeLessThan(5);
    expect(taller).toBeLessThan(0.01);
    expect(notes).toMatch(
      /rest pose is not a T-pose; it was estimated from the motion \(trunk, head, left arm.* of 1 sure\)/,
    );
  });

  test.each<[string, string, number, RegExp]>([
    ['its head has a quarter turn', 'Head', 90, /estimated from the motion \(head\)/],
    ['its head is upside down', 'Head', 180, /estimated from the motion \(head\)/],
    ['its chest has half a turn', 'Spine1', 180, /estimated from the motion \(trunk\)/],
    ['its hips have half a turn', 'Hips', 180, /estimated from the motion \(trunk\)/],
  ])('%s', (_, joint, degrees, note) => {
    const axis = joint === 'Head' && degrees === 180 ? forward : up;
    const turn = fromAxisAngle(axis, (degrees * Math.PI) / 180);
    const found = compared(plain, { rollOf: (name) => (name === joint ? turn : quat(0, 0, 0, 1)) });
    expect(found.furthest).toBeLessThan(0.1);
    expect(found.cosine).toBeGreaterThan(0.9999);
    expect(found.hands).toBeLessThan(0.1);
    expect(found.notes).toMatch(note);
  });
});

describe('a trunk that rests along another axis than arms and legs keeps its T-pose in', () => {
  const sideways = fromAxisAngle(right, -Math.PI / 2);
  const rollOf = (name: string) => {
    if (/^(Spine|Neck|Head)/.test(name)) return fromAxisAngle(forward, Math.PI / 2);
    return /^Left/.test(name) ? multiply(sideways, sideways) : sideways;
  };
  test.each([
    ['a walk', [0, 0, 0]],
    ['a walk with a deep stoop', [0, 38, 0]],
  ] as const)('%s', (_, stoop) => {
    const anglesAt = (name: string, time: number) => (/^Spine/.test(name) ? stoop : walkingAnglesAt(name, time));
    const { furthest, cosine, taller } = compared(madeBvh({ ...walk, anglesAt }), { rollOf });
    expect(furthest).toBeLessThan(0.1);
    expect(cosine).toBeGreaterThan(0.9999);
    expect(taller).toBeLessThan(0.001);
  });
});

test('a head that mostly looks aside rests at the right angle that is next', () => {
  const anglesAt = (name: string, time: number) => {
    const [z, x, y] = walkingAnglesAt(name, time);
    return [z, x, name === 'Head' ? y + 40 : y] as const;
  };
  const { cosine } = compared(madeBvh({ ...walk, anglesAt }), { rollOf: rolls(3, 'right angles') });
  expect(cosine).toBeGreaterThan(0.9999);
});

describe('joints with any frames keep their places and the gaze in', () => {
  const sitting = (name: string, time: number) => {
    if (/UpLeg/.test(name)) return [0, -88 + 4 * Math.sin(3 * time), 0] as const;
    return /Leg/.test(name) ? ([0, 85, 0] as const) : walkingAnglesAt(name, time);
  };
  test.each([
    ['a walk of a second', { ...walk, frames: 60 }, {}],
    ['a walk backward', { ...walk, speed: -130 }, {}],
    ['a walk without toes', { ...walk, without: ['LeftToe', 'RightToe'] }, {}],
    ['a walk backward without toes', { ...walk, speed: -130, without: ['LeftToe', 'RightToe'] }, {}],
    ['a file in metres', { ...walk, unit: 0.01 }, {}],
    ['a file with Z up', walk, { turn: zUp }],
    ['a person who sits', { ...walk, speed: 0, rootPlace: [0, 50, 0] as const, anglesAt: sitting }, {}],
  ])('%s', (_, made, options) => {
    const found = compared(madeBvh(made), { ...options, rollOf: rolls(11, 'any angles') });
    expect(found.furthest).toBeLessThan(0.5);
    expect(found.cosine).toBeGreaterThan(0.99);
  });

  test('a still clip, which is doubted', () => {
    const still = madeBvh({ ...walk, speed: 0, anglesAt: (name) => walkingAnglesAt(name, 0.3) });
    const { furthest, doubts } = compared(still, { rollOf: rolls(11, 'any angles') });
    expect(furthest).toBeLessThan(0.1);
    expect(doubts.join()).toMatch(/T-pose is uncertain \(0\.\d\d of 1\): the motion hardly shows/);
    expect(prepare(still).doubts).toEqual([]);
  });
});

describe('frames decide the sides against the names of', () => {
  const without = ['LeftToe', 'RightToe'];
  test.each<[string, RegExp, string]>([
    ['both arms and legs', /^(Left|Right)/, 'both arms and legs'],
    ['arms', /^(Left|Right)(?=Shoulder|Arm|ForeArm|Hand)/, 'arms'],
    ['legs', /^(Left|Right)(?=UpLeg|Leg|Foot)/, 'legs'],
  ])('%s, by knees and shoulders', (_, named, which) => {
    const nameOf = (name: string) => name.replace(named, swap);
    for (const speed of [130, -130]) {
      const found = compared(madeBvh({ ...walk, speed, without }), { nameOf, rollOf: rolls(3, 'any angles') });
      expect(found.furthest).toBeLessThan(0.5);
      expect(found.cosine).toBeGreaterThan(0.99);
      expect(found.notes).toMatch(new RegExp(`names of left and right are exchanged on its ${which}:`));
    }
  });

  test('names that mean nothing: knees and the way walked show the sides', () => {
    const codes = new Map(motionOf(madeBvh(walk)).names.map((name, i) => [name, `q${i * 7}x`]));
    const found = compared(madeBvh({ ...walk, without }), {
      nameOf: (name) => codes.get(name)!,
      rollOf: rolls(3, 'right angles'),
    });
    expect(found.furthest).toBeLessThan(0.5);
    expect(found.cosine).toBeGreaterThan(0.99);
  });
});

test('a first frame in T-pose gives the rest of joints with any frames exactly', () => {
  const posed = (name: string, time: number) => (time === 0 ? ([0, 0, 0] as const) : walkingAnglesAt(name, time));
  const { furthest, cosine, hands, notes } = compared(madeBvh({ ...walk, anglesAt: posed }), {
    rollOf: rolls(5, 'any angles'),
  });
  expect(furthest).toBeLessThan(0.1);
  expect(cosine).toBeGreaterThan(0.9999);
  expect(hands).toBeLessThan(0.1);
  expect(notes).toMatch(/that of its first frame was taken/);
});
