import { describe, expect, test } from 'vitest';
import { readGlbChunks } from '../../../../src/threepoint/avatar/file/glb-chunks';
import { defaultCalibration } from '../../../../src/threepoint/core/body/calibration';
import { angleBetween, conjugate, multiply, quat } from '../../../../src/threepoint/core/math/quat';
import { doubtOfErrors } from '../../../../src/threepoint/core/mocap/doubts';
import { prepareMocap } from '../../../../src/threepoint/core/mocap/prepare-mocap';
import { trackedWidth } from '../../../../src/threepoint/core/mocap/simulate-trackers';
import { truthJoints } from '../../../../src/threepoint/core/mocap/skeleton-map';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { writeVrma } from '../../../../src/threepoint/core/motion/write-vrma';
import { actingPerson, bytesOf } from '../motion/moved-person';
import { goldenMocap, sourceOf } from './golden-mocap';
import { type MadeOptions, madeBvh } from './made-bvh';

const prepare = (text: string) => finishWork(prepareMocap({ format: 'bvh', name: 'wave.bvh', text }));
const plain = madeBvh();
const expected = prepare(plain).clips[0]!;

/** How far joints and trackers lie from those of the plain file [mm], at most; joints that are assumed do not count. */
function furthest(text: string, assumed: readonly string[] = []): number {
  const { clips } = prepare(text);
  expect(clips).toHaveLength(1);
  const { truth, tracked, frameCount } = clips[0]!;
  expect(frameCount).toBeGreaterThanOrEqual(expected.frameCount - 1);
  let most = 0;
  const width = 3 * truthJoints.length;
  for (let frame = 0; frame < Math.min(frameCount, expected.frameCount); frame++) {
    for (const [i, joint] of truthJoints.entries()) {
      if (assumed.includes(joint)) continue;
      for (let k = 0; k < 3; k++) {
        const at = frame * width + 3 * i + k;
        most = Math.max(most, Math.abs(truth[at]! - expected.truth[at]!));
      }
    }
    for (let i = 0; i < trackedWidth; i++) {
      // Rotations have both signs; trackers lie within a hand's breadth, so that an error of 0.01 counts 1 mm.
      if (i % 7 >= 3) continue;
      const at = frame * trackedWidth + i;
      most = Math.max(most, Math.abs(tracked[at]! - expected.tracked[at]!));
    }
  }
  return 1000 * most;
}

const collar = (name: string): string =>
  name
    .replace(/^Spine$/, 'Chest')
    .replace(/^Spine1$/, 'Chest2')
    .replace(/(Left|Right)(Shoulder|Arm|ForeArm|Hand|UpLeg|Leg|Foot)$/, (_, side: string, part: string) => {
      const parts: Readonly<Record<string, string>> = {
        ...{ Shoulder: 'Collar', Arm: 'Shoulder', ForeArm: 'Elbow', Hand: 'Wrist' },
        ...{ UpLeg: 'Hip', Leg: 'Knee', Foot: 'Ankle' },
      };
      return side + parts[part];
    });
const smpl = (name: string): string =>
  collar(name)
    .replace('Hips', 'Pelvis')
    .replace('Chest2', 'Spine3')
    .replace('Chest', 'Spine1')
    .replace('Left', 'L_')
    .replace('Right', 'R_')
    .replace('Toe', 'Foot');

const lines = plain.split('\n');

/** Lets the hips hang from a reference that lies 8 m away at rest. */
const underReference = (text: string): string =>
  text
    .replace(
      /ROOT (Hips\n\{\n)\tOFFSET.*/,
      `ROOT Reference\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT $1OFFSET 0 90 -800`,
    )
    .replace('\nMOTION', '\n}\nMOTION')
    .replaceAll(/^(?=0\.0000 95\.)/gm, '0 0 0 ');

const named: readonly (readonly [string, MadeOptions])[] = [
  ['a prefix of Mixamo', { nameOf: (name) => `mixamorig:${name}` }],
  ['names with spaces', { nameOf: (name) => name.replace(/(Left|Right)/, '$1 ') }],
  ['collar, shoulder, elbow and wrist', { nameOf: collar }],
  ['the names of SMPL', { nameOf: smpl }],
  ['names that mean nothing', { nameOf: (name) => `x${[...name].map((letter) => letter.charCodeAt(0)).join('')}q` }],
  ['decimetres', { unit: 0.1 }],
  ['metres', { unit: 0.01 }],
  ['inches', { unit: 1 / 2.54 }],
  ['six channels everywhere', { positionOf: (offset) => offset }],
  ['the head as its root', { fromHead: true }],
];

describe('a BVH is read alike with', () => {
  test.each(named)('%s', (_, options) => {
    expect(furthest(madeBvh(options))).toBeLessThan(1);
  });

  test('a unit that is neither metres nor centimetres, which is said', () => {
    expect(prepare(madeBvh({ unit: 0.1 })).notes.join()).toMatch(/its unit was taken to be that of decimetres/);
    expect(prepare(madeBvh({ unit: 0.01 })).notes).toEqual([]);
  });

  test('a unit that fits no person: the body gets average height, or average arms without legs', () => {
    const { clips, notes } = prepare(madeBvh({ unit: 4.2 }));
    const { eyeHeight, armSpan } = clips[0]!.calibration;
    expect(notes.join()).toMatch(/its unit is unknown: its body was scaled to a height of 1\.70 m/);
    expect(eyeHeight).toBeCloseTo(defaultCalibration.eyeHeight, 6);
    expect(armSpan / expected.calibration.armSpan).toBeCloseTo(eyeHeight / expected.calibration.eyeHeight, 2);
    const without = ['Left', 'Right'].flatMap((side) => ['UpLeg', 'Leg', 'Foot', 'Toe'].map((part) => side + part));
    const legless = prepare(madeBvh({ unit: 4.2, without }));
    expect(legless.notes.join()).toMatch(/its unit is unknown: its body was scaled to arms of 0\.\d\d m/);
    expect(Math.abs(legless.clips[0]!.calibration.armSpan / defaultCalibration.armSpan - 1)).toBeLessThan(0.1);
  });

  test.each<[string, string, RegExp | null]>([
    ['a byte order mark', `\ufeff${plain}`, null],
    ['a brace on the joint’s line', plain.replaceAll(/\n\s*\{/g, ' {'), null],
    ['comments', `# made by hand\n${plain.replace('MOTION', '# frames\nMOTION\n  # 60 of them')}`, null],
    ['a reference far away from the hips', underReference(plain), null],
    ['lines that end with CR alone', plain.replaceAll('\n', '\r'), null],
    ['lines that end with CR and LF', plain.replaceAll('\n', '\r\n'), null],
    [
      'commas for decimals',
      madeBvh({ numberOf: (value) => value.toFixed(4).replace('.', ',') }),
      /commas for decimals/,
    ],
    ['one frame too many declared', plain.replace('Frames: 60', 'Frames: 61'), /Frames says 61, there are 60/],
    ['one frame too few declared', plain.replace('Frames: 60', 'Frames: 59'), /Frames says 59, there are 60/],
    ['its last row cut', lines.with(-2, lines.at(-2)!.slice(0, 90)).join('\n'), /last row is cut short/],
    ['zero positions on every joint', madeBvh({ positionOf: () => [0, 0, 0] }), /positions of \d+ joints are zero/],
    ['a motion with Z up', madeBvh({ rootZUp: true }), /the axis that makes them stand was taken as up \(\+z\)/],
    [
      'a rest with Z up, the motion with Y up',
      madeBvh({ offsetOf: ([x, y, z]) => [x, -z, y] }),
      /rest stands along \+z.*turned to the motion/,
    ],
  ])('%s', (_, text, note) => {
    expect(furthest(text)).toBeLessThan(1);
    const { notes } = prepare(text);
    if (note) expect(notes.join('\n')).toMatch(note);
    else expect(notes).toEqual([]);
  });

  test.each([
    ['without a frame time', plain.replace(/Frame Time.*\n/, '')],
    ['with a frame time of nothing', plain.replace(/Frame Time.*/, 'Frame Time: 0.0')],
  ])('twice as slow %s, which is said', (_, text) => {
    const { clips, notes } = prepare(text);
    expect(clips[0]!.frameCount).toBe(2 * expected.frameCount - 1);
    expect(notes.join()).toMatch(/does not state its frame rate; 30 frames a second are assumed/);
  });

  test('hands that hang from level arms at rest and never in the motion, which is said', () => {
    const { clips, notes } = prepare(madeBvh({ anglesOf: { LeftHand: [-90, 0, 0], RightHand: [90, 0, 0] } }));
    expect(notes.join('\n')).toMatch(
      /rest pose is not a T-pose; it was estimated from the motion \(left hand, right hand\)/,
    );
    for (const hand of [7, 14]) {
      const turnOf = (from: Float32Array) => {
        const [x, y, z, w] = from.subarray(30 * trackedWidth + hand + 3) as unknown as [number, number, number, number];
        return quat(x, y, z, w);
      };
      expect(turnOf(clips[0]!.tracked)).toBeSameRotationAs(turnOf(expected.tracked), 1);
    }
  });

  test('a person on a step whose hips stand as far aside as above the feet', () => {
    const { clips, notes } = prepare(madeBvh({ rootPlace: [95, 130, 0] }));
    expect(notes).toEqual([]);
    expect(clips[0]!.truth[1]).toBeCloseTo(expected.truth[1]!, 1);
  });

  test('left and right exchanged in its names, which is said', () => {
    const swapped = madeBvh({
      nameOf: (name) => name.replace(/Left|Right/, (word) => (word === 'Left' ? 'Right' : 'Left')),
    });
    expect(furthest(swapped)).toBeLessThan(1);
    expect(prepare(swapped).notes.join()).toMatch(/names of left and right are exchanged/);
  });
});

describe('without its map, a skeleton is read as with it', () => {
  const width = 3 * truthJoints.length;
  test.each([
    ['folded_1.bvh', 1],
    ['sideways_1.bvh', 1],
  ])('%s', (name, degrees) => {
    const golden = goldenMocap.find(({ motion }) => motion === name)!;
    const { 'map.json': _, ...files } = golden.files;
    const mapped = finishWork(prepareMocap(sourceOf(golden))).clips[0]!;
    const found = finishWork(prepareMocap(sourceOf({ ...golden, files })));
    const clip = found.clips[0]!;
    expect(found.notes.length).toBeGreaterThan(0);
    // The heading of a clip without a map may differ from the map's by right angles.
    const shape = ({ truth }: typeof clip) => {
      const values: number[] = [];
      for (let at = 0; at < truth.length; at += 3) {
        const hips = at - (at % width);
        values.push(truth[at + 1]!, Math.hypot(truth[at]! - truth[hips]!, truth[at + 2]! - truth[hips + 2]!));
      }
      return values;
    };
    const [one, other] = [shape(clip), shape(mapped)];
    expect(one).toHaveLength(other.length);
    for (const [i, value] of one.entries()) expect(value).toBeCloseTo(other[i]!, 3);
    // The rotation between headset and left hand does not depend on the heading.
    const between = ({ tracked }: typeof clip, frame: number) => {
      const [head, hand] = [3, 10].map((k) => {
        const [x, y, z, w] = tracked.subarray(frame * trackedWidth + k, frame * trackedWidth + k + 4);
        return quat(x!, y!, z!, w!);
      });
      return multiply(conjugate(head!), hand!);
    };
    for (let frame = 0; frame < mapped.frameCount; frame++)
      expect(angleBetween(between(clip, frame), between(mapped, frame))).toBeLessThan((degrees * Math.PI) / 180);
  });
});

describe('a VRM Animation without', () => {
  const { json, binary } = readGlbChunks(bytesOf(writeVrma(actingPerson(1).motion)))!;
  const without = (bone: string | null) => {
    const description = JSON.parse(json);
    if (bone) delete description.extensions.VRMC_vrm_animation.humanoid.humanBones[bone];
    return finishWork(prepareMocap({ format: 'gltf', name: 'wave.vrma', description, binary }));
  };
  const whole = without(null).clips[0]!;

  test.each(['chest', 'neck'])('%s is read, and what is assumed is said', (bone) => {
    const { clips, notes } = without(bone);
    expect(notes.join()).toMatch(new RegExp(`it has no ${bone}; one .* is assumed`));
    let off = 0;
    for (const [i, value] of whole.truth.entries()) {
      const joint = truthJoints[Math.floor(i / 3) % truthJoints.length]!;
      const difference = Math.abs(value - clips[0]!.truth[i]!);
      if (joint === bone) off = Math.max(off, difference);
      else if (Number.isFinite(value)) expect(difference, joint).toBeLessThan(1e-3);
    }
    // The assumed joint lies within a hand's breadth of the one that was left out.
    expect(off).toBeLessThan(0.1);
  });
});

test('lost bones of cmuconvert are put back once, whether joints have three channels or six', () => {
  const [three, six] = [{}, { positionOf: (offset: readonly [number, number, number]) => offset }].map((options) =>
    prepare(madeBvh({ cmuconvert: true, ...options })),
  );
  expect(three!.notes.join()).toMatch(/lost the thorax bone.*lost the left wrist bone.*lost the right wrist bone/);
  expect(six!.notes).toEqual(three!.notes);
  const [one, other] = [three!.clips[0]!.truth, six!.clips[0]!.truth];
  expect(other).toHaveLength(one.length);
  for (const [i, value] of one.entries()) expect(Math.abs(other[i]! - value)).toBeLessThan(1e-6);
  const at = (joint: (typeof truthJoints)[number]) => one[3 * truthJoints.indexOf(joint) + 1]!;
  expect(at('neck') - at('hips')).toBeGreaterThan(0.35);
});

describe('what cannot be right is said', () => {
  const doubts = (options: MadeOptions) =>
    finishWork(prepareMocap({ format: 'bvh', name: 'wave.bvh', text: madeBvh(options) })).doubts.join();

  test('a pelvis that is not over the feet is doubted', () => {
    expect(doubts({})).toBe('');
    const aside = (name: string) => /UpLeg$/.test(name);
    expect(doubts({ offsetOf: ([x, y, z], name) => (aside(name) ? [x, y, z + 60] : [x, y, z]) })).toMatch(
      /the pelvis is 6\d cm off the middle of the feet/,
    );
  });

  test('a person who lies on the floor throughout is doubted', () => {
    const lying: MadeOptions = { rootZUp: true, rootPlace: [0, 12, 0] };
    expect(doubts(lying)).toMatch(/the trunk lies in most frames/);
    expect(prepare(madeBvh(lying)).notes).toEqual([]);
  });

  test('elbows that stay behind the back are doubted', () => {
    const back = (degrees: number): MadeOptions => ({
      anglesOf: { LeftArm: [0, 0, degrees], RightArm: [0, 0, -degrees] },
    });
    expect(doubts(back(60))).toBe('this cannot be right: both elbows are behind the back in most frames');
    expect(doubts(back(-60))).toBe('');
    expect(doubts(back(10))).toBe('');
  });

  test('errors over 12 cm by every method are doubted', () => {
    expect(doubtOfErrors([13, 20])).toMatch(/the error of every method is over 12 cm/);
    expect(doubtOfErrors([13, 9])).toBeNull();
    expect(doubtOfErrors([])).toBeNull();
  });
});

describe('a BVH is refused with a sentence for', () => {
  test.each<[string, string, RegExp]>([
    [
      'both commas and points',
      madeBvh({ numberOf: (value) => (value === 95 ? '95,0' : value.toFixed(4)) }),
      /both commas and points/,
    ],
    [
      'no arms',
      madeBvh({
        without: lines.flatMap((line) => /JOINT ((?:Left|Right)(?:Shoulder|Arm|ForeArm|Hand))/.exec(line)?.[1] ?? []),
      }),
      /no leftUpperArm/,
    ],
  ])('%s', (_, text, sentence) => {
    expect(() => prepare(text)).toThrow(sentence);
  });
});
