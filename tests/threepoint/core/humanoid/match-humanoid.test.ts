import fc from 'fast-check';
import { neededBones, type SkeletonJoint } from 'threepoint/core';
import { distance, lerp, normaliseQuat, quat, rotate, scale } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { humanoidProblem, matchHumanoid, minConfidence } from '../../../../src/threepoint/core/humanoid/match-humanoid';
import { rigs } from './rigs';

/** The names of the matched joints by bone. */
const named = (joints: readonly SkeletonJoint[]) => {
  const { map } = matchHumanoid(joints);
  return Object.fromEntries(Object.entries(map).map(([bone, { joint }]) => [bone, joints[joint]!.name]));
};
const renamed = (joints: readonly SkeletonJoint[], nameOf: (joint: SkeletonJoint, i: number) => string) =>
  joints.map((joint, i) => ({ ...joint, name: nameOf(joint, i) }));
const inner = (bone: string): boolean =>
  !/Thumb|Index|Middle|Ring|Little|Eye|jaw|Toes|upperChest|Shoulder|neck/.test(bone);

describe.each(rigs)('the skeleton of $name', ({ name, joints, bones }) => {
  const expected = Object.fromEntries(Object.entries(bones).map(([bone, i]) => [bone, joints[i]!.name]));

  test('has its bones', () => {
    const match = matchHumanoid(joints);
    expect(named(joints)).toMatchObject(expected);
    expect(humanoidProblem(match)).toBeNull();
    expect(match.notes).toEqual([]);
    expect(match.confidence).toBeGreaterThan(minConfidence + 0.1);
  });

  test('has its hips, spine, head, arms and legs under any names', () => {
    // Legs without a foot are known by their names alone.
    if (name === 'feet that follow a control') return;
    const main = Object.entries(bones).filter(([bone]) => inner(bone));
    fc.assert(
      fc.property(fc.infiniteStream(fc.stringMatching(/^[a-z]{3}\d$/)), (names) => {
        const stream = names[Symbol.iterator]();
        // Letters before the random ones keep the names from meaning anything.
        const other = renamed(joints, () => `zq${stream.next().value}`.replaceAll(/[aeioulr]/g, 'x'));
        const { map } = matchHumanoid(other);
        // Wrist and hand may be two joints, 3 cm apart.
        for (const [bone, joint] of main) {
          const found = joints[map[bone as keyof typeof map]?.joint ?? -1];
          expect(found && distance(found.position, joints[joint]!.position), bone).toBeLessThan(4);
        }
      }),
      { numRuns: 3 },
    );
  });

  test('is found in any unit and turned in any way', () => {
    const turn = normaliseQuat(quat(0.3, -0.5, 0.2, 0.7));
    const moved = joints.map((joint) => ({ ...joint, position: scale(rotate(turn, joint.position), 0.01) }));
    expect(named(moved)).toMatchObject(expected);
  });

  test('has left and right by the joints where its names exchange them', () => {
    const swap = (name: string) =>
      name
        .replace(/Left|Right/, (side) => (side === 'Left' ? 'Right' : 'Left'))
        .replace(
          /(?<![A-Za-z])[LRlr](?![a-z])|(?<=[a-z])[LR]$|^[lr](?=[A-Z])/,
          (side) => ({ L: 'R', R: 'L', l: 'r', r: 'l' })[side]!,
        );
    const { map, notes } = matchHumanoid(renamed(joints, ({ name }) => swap(name)));
    if (bones.leftToes === undefined) return;
    expect(notes.join()).toMatch(/left and right are exchanged/);
    for (const bone of ['leftHand', 'rightHand', 'leftFoot'] as const) expect(map[bone]?.joint).toBe(bones[bone]);
  });
});

/** Wings in the unit of `rigs`, from where they leave the spine. */
const wings: readonly (readonly [string, readonly (readonly [number, number, number])[]])[] = [
  ['of three joints, spread', [[8, 3, -12], [45, 35, -20], [90, 20, -25]]],
  ['of four joints, spread', [[8, 3, -12], [30, 30, -20], [60, 35, -22], [95, 10, -25]]],
  ['of four joints, folded', [[8, 3, -12], [30, 10, -20], [45, -40, -22], [50, -80, -25]]],
]; // biome-ignore format: a place a wing

test.each(wings)('wings without names %s are no arms and no head', (_, places) => {
  for (const { name, joints, bones } of rigs) {
    // Legs without a foot are known by their names alone.
    if (name === 'feet that follow a control') continue;
    const nameless: SkeletonJoint[] = renamed(joints, (_, i) => `q${i}`);
    const root = joints[bones.leftShoulder ?? bones.leftUpperArm!]!.parent;
    const from = joints[root]!.position;
    for (const sign of [1, -1])
      for (const [k, [x, y, z]] of places.entries())
        nameless.push({
          name: `q${nameless.length}`,
          parent: k === 0 ? root : nameless.length - 1,
          position: { x: from.x + sign * x, y: from.y + y, z: from.z + z },
        });
    const { map } = matchHumanoid(nameless);
    for (const bone of ['head', 'leftUpperArm', 'rightLowerArm', 'rightHand', 'leftFoot'] as const) {
      const found = nameless[map[bone]?.joint ?? -1];
      // A hand may be the joint beyond the wrist.
      expect(found && distance(found.position, joints[bones[bone]!]!.position), `${name}: ${bone}`).toBeLessThan(4);
    }
  }
});

test('a joint in the place of the chest is no neck where another one is', () => {
  const { joints, bones } = rigs.find(({ name }) => name === 'Mixamo')!;
  const [neck, added] = [bones.neck!, joints.length];
  const { parent } = joints[neck]!;
  const doubled = [
    ...joints.map((joint, i) => (i === neck ? { ...joint, parent: added } : joint)),
    { name: 'lowerneck', parent, position: joints[parent]!.position },
  ];
  expect(matchHumanoid(doubled).map.neck?.joint).toBe(neck);
});

test('ends of chains that move no skin may lie anywhere', () => {
  for (const { joints, bones } of rigs.filter(({ name }) => /Quaternius|feet that follow a control/.test(name))) {
    const leaf = (i: number) => joints.every(({ parent }) => parent !== i);
    const skinned = joints.map((joint) => ({ ...joint, weight: joint.end ? 0 : 1 }));
    const ends = joints.flatMap(({ name, position }, i): SkeletonJoint[] =>
      leaf(i) ? [{ name: `${name}_end`, parent: i, position: scale(position, 100), weight: 0 }] : [],
    );
    for (const whole of [
      [...skinned, ...ends],
      [...joints, ...ends.map(({ weight: _, ...end }) => end)],
    ]) {
      const { map } = matchHumanoid(whole);
      for (const [bone, joint] of Object.entries(bones)) expect(map[bone as keyof typeof map]?.joint, bone).toBe(joint);
    }
  }
});

describe.each(rigs.filter(({ name }) => /^(LAFAN1|Mixamo)$/.test(name)))(
  'the arms of $name with more bones in line, without telling names',
  ({ joints, bones }) => {
    test.each([
      [2, 1],
      [1, 2],
      [2, 2],
      [3, 1],
      [1, 3],
      [3, 2],
      [3, 3],
    ])('%i from shoulder to elbow, %i from elbow to wrist', (upper, lower) => {
      const longer = joints.map((joint) => ({ ...joint }));
      for (const side of ['left', 'right'] as const) {
        const [shoulder, elbow, hand] = [`${side}UpperArm`, `${side}LowerArm`, `${side}Hand`] as const;
        for (const [from, to, count] of [
          [bones[shoulder]!, bones[elbow]!, upper],
          [bones[elbow]!, bones[hand]!, lower],
        ] as const) {
          let parent = from;
          for (let i = 1; i < count; i++) {
            const position = lerp(joints[from]!.position, joints[to]!.position, i / count);
            parent = longer.push({ name: '', parent, position }) - 1;
          }
          longer[to] = { ...longer[to]!, parent };
        }
      }
      const { map } = matchHumanoid(renamed(longer, (_, i) => `q${i}`));
      for (const bone of neededBones.filter((each) => /Arm|Hand/.test(each))) {
        const found = longer[map[bone]?.joint ?? -1];
        // Wrist and hand may be two joints, 3 cm apart.
        expect(found && distance(found.position, joints[bones[bone]!]!.position), bone).toBeLessThan(4);
      }
    });
  },
);

test('the fingers of Perception Neuron begin beyond its bones inside the hand', () => {
  const { joints, bones } = rigs.find(({ name }) => name === 'Mixamo')!;
  const longer = joints.map((joint) => ({ ...joint, name: joint.name.replace('mixamorig:', '') }));
  for (const finger of ['Index', 'Middle', 'Ring', 'Little'] as const) {
    for (const side of ['left', 'right'] as const) {
      const [hand, first] = [bones[`${side}Hand`]!, bones[`${side}${finger}Proximal`]!];
      const position = lerp(joints[hand]!.position, joints[first]!.position, 0.3);
      const name = longer[first]!.name.replace(/Hand(\w+)1$/, 'InHand$1');
      longer[first] = { ...longer[first]!, parent: longer.push({ name, parent: hand, position }) - 1 };
    }
  }
  const { map } = matchHumanoid(longer);
  expect(Object.fromEntries(Object.entries(map).map(([bone, { joint }]) => [bone, joint]))).toMatchObject(bones);
});

describe('what is no humanoid is refused with what was found and what is missing', () => {
  const at = (x: number, y: number) => ({ x, y, z: 0 });
  test.each<[string, readonly SkeletonJoint[], RegExp]>([
    ['nothing', [], /none of its 0 joints is part of a humanoid; no hips, no spine/],
    [
      'a chain',
      [0, 1, 2, 3].map((i) => ({ name: `bone${i}`, parent: i - 1, position: at(0, i) })),
      /none of its 4 joints/,
    ],
    [
      'a circle',
      [0, 1, 2].map((i) => ({ name: `ring${i}`, parent: (i + 1) % 3, position: at(i, 0) })),
      /none of its 3 joints/,
    ],
    [
      'an upper half by name alone',
      ['Hips', 'Spine', 'Head', 'LeftHand'].map((name, i) => ({ name, parent: i - 1, position: at(0, i) })),
      /found hips \(Hips\), spine \(Spine\), head \(Head\), leftHand \(LeftHand\); no leftUpperArm/,
    ],
  ])('%s', (_, joints, sentence) => {
    const match = matchHumanoid(joints);
    expect(humanoidProblem(match)).toMatch(sentence);
    expect(match.missing.length).toBeGreaterThan(0);
    expect(match.confidence).toBe(0);
  });

  test('an animal on four legs, despite two pairs of limbs, a spine and a head', () => {
    const joints: SkeletonJoint[] = [
      { name: 'a', parent: -1, position: { x: 0, y: 60, z: 0 } },
      { name: 'b', parent: 0, position: { x: 0, y: 60, z: 25 } },
      { name: 'c', parent: 1, position: { x: 0, y: 60, z: 50 } },
      { name: 'd', parent: 2, position: { x: 0, y: 75, z: 65 } },
    ];
    for (const [root, z] of [[0, 0], [2, 50]] as const) // biome-ignore format: one thought
      for (const x of [-8, 8])
        for (const [i, y] of [58, 30, 3].entries())
          joints.push({ name: `e${joints.length}`, parent: i === 0 ? root : joints.length - 1, position: { x, y, z } });
    expect(humanoidProblem(matchHumanoid(joints))).toMatch(/none of its 16 joints/);
  });

  test('a bird, whose wings are where a human has arms', () => {
    const { joints } = rigs.find(({ name }) => name === 'LAFAN1')!;
    const wings = ['Shoulder', 'Arm', 'ForeArm', 'Hand'];
    const bird = renamed(joints, ({ name }) =>
      name.replace(/(?<=^Left|^Right)(Shoulder|Arm|ForeArm|Hand)$/, (part) => `Wing${wings.indexOf(part)}`),
    );
    const match = matchHumanoid(bird);
    expect(humanoidProblem(match)).toMatch(/no leftUpperArm, no leftLowerArm, no leftHand/);
    expect(match.map.leftFoot).toBeDefined();
  });

  const without = (part: RegExp) => {
    const { joints, bones } = rigs.find(({ name }) => name === 'LAFAN1')!;
    const gone = new Set(Object.entries(bones).flatMap(([bone, joint]) => (part.test(bone) ? [joint] : [])));
    const kept = joints.flatMap((joint, i) => (gone.has(i) ? [] : [{ ...joint, name: `q${i}`, i }]));
    const heir = (joint: number): number => (gone.has(joint) ? heir(joints[joint]!.parent) : joint);
    return kept.map((joint) => ({ ...joint, parent: kept.findIndex(({ i }) => i === heir(joint.parent)) }));
  };

  test('arms that end without hands, and everything else is found', () => {
    const match = matchHumanoid(without(/Hand|Shoulder/));
    expect(match.missing).toEqual(['leftHand', 'rightHand']);
    expect(humanoidProblem(match)).toMatch(/found hips \(q0\), spine .* no leftHand, no rightHand/);
    expect(Object.keys(match.map)).toEqual(expect.arrayContaining(['head', 'leftLowerArm', 'rightFoot']));
  });

  test('one pair of limbs without names, which may be arms or legs', () => {
    expect(humanoidProblem(matchHumanoid(without(/Leg|Foot|Toes/)))).toMatch(/none of its \d+ joints/);
  });

  test('any tree of joints gets an answer within a second', () => {
    const joint = fc.record({
      name: fc.oneof(
        fc.string({ maxLength: 12 }),
        fc.constantFrom('LeftArm', 'RightHand', 'Hips', 'L', 'spine_01', 'thigh.l'),
      ),
      parent: fc.integer({ min: -2, max: 60 }),
      position: fc.record({ x: fc.float(), y: fc.float({ noNaN: true }), z: fc.float({ noNaN: true }) }),
    });
    fc.assert(
      fc.property(fc.array(joint, { maxLength: 60 }), (joints) => {
        const { map, missing } = matchHumanoid(joints);
        for (const { joint: index } of Object.values(map)) expect(joints[index]).toBeDefined();
        for (const bone of neededBones) expect(missing.includes(bone)).toBe(map[bone] === undefined);
      }),
    );
  });

  test.each([
    ['a comb', (i: number) => (i % 4 === 0 ? i - 4 : i - 1)],
    ['a chain', (i: number) => i - 1],
    ['a star of chains', (i: number) => (i % 3 === 1 ? 0 : i - 1)],
    ['a binary tree', (i: number) => (i - 1) >> 1],
  ])('%s of 5000 joints gets an answer within a second', (_, parentOf) => {
    const joints = Array.from({ length: 5000 }, (_, i) => ({
      name: `LeftArm${i}`,
      parent: i === 0 ? -1 : Math.max(0, parentOf(i)),
      position: at(i % 7, i % 11),
    }));
    const start = process.cpuUsage();
    matchHumanoid(joints);
    expect(process.cpuUsage(start).user / 1e3, 'milliseconds of work').toBeLessThan(1000);
  });
});
