import { describe, expect, test } from 'vitest';
import { prepareMocap } from '../../../../src/threepoint/core/mocap/prepare-mocap';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { goldenMocap, sourceOf } from './golden-mocap';

const acclaim = goldenMocap.find(({ motion }) => motion.endsWith('.amc'))!;
const walk = goldenMocap.find(({ motion }) => motion === 'someone_walks.bvh')!;
const skeletonName = '11.asf';

type Change = (text: string) => string;
const unchanged: Change = (text) => text;
const prepare = (golden: typeof walk, file: string, change: Change) =>
  finishWork(prepareMocap(sourceOf({ ...golden, files: { ...golden.files, [file]: change(golden.files[file]!) } })));
const lineOf = (text: string, line: string): number => text.split('\n').indexOf(line) + 1;

describe('a damaged AMC is refused in a sentence that says where', () => {
  const { motion } = acclaim;
  const text = acclaim.files[motion]!;
  const second = lineOf(text, '2');
  test.each<[string, Change, RegExp]>([
    ['empty', () => '', /^11_07\.amc: line 1, column 1: no frames$/],
    ['prose', () => 'Dear Sir', /^11_07\.amc: line 1, column 1: “Dear” is no bone with freedom in 11\.asf$/],
    [
      'cut short',
      (all) => all.slice(0, all.length / 2),
      /column \d+: (frame \d+ ends without|.* numbers, its skeleton says)/,
    ],
    [
      'a frame without a bone',
      (all) => all.replace(/^thorax.*\n/m, ''),
      new RegExp(`line ${second - 1}, column 1: frame 1 ends without “thorax”`),
    ],
    ['not a number', (all) => all.replace(/^head \S+/m, 'head NaN'), /column 6: “NaN” is no finite number/],
    [
      'a bone of another skeleton',
      (all) => all.replace(/^head /m, 'tail '),
      /column 1: “tail” is no bone with freedom/,
    ],
    ['too many numbers', (all) => all.replace(/^head /m, 'head 1 '), /head has 4 numbers, its skeleton says 3/],
    ['one line without an end', () => 'x'.repeat(2e6), /line 1, column \d+: the line does not end/],
  ])('%s', (_, change, sentence) => {
    expect(() => prepare(acclaim, motion, change)).toThrow(sentence);
  });
});

test('an AMC whose name tells no rate is read at 120 Hz, which is said', () => {
  const { files } = acclaim;
  const read = (name: string) => {
    const renamed = {
      ...acclaim,
      motion: name,
      files: { [name]: files[acclaim.motion]!, [skeletonName]: files[skeletonName]! },
    };
    return finishWork(prepareMocap(sourceOf(renamed)));
  };
  const [known, assumed] = [read('01_02.amc'), read('dance.amc')];
  expect(assumed.clips[0]!.truth).toEqual(known.clips[0]!.truth);
  expect(known.notes.join()).not.toMatch(/frame rate/);
  expect(assumed.notes.join()).toMatch(/does not state its frame rate; 120 frames a second are assumed/);
});

describe('a damaged ASF is refused in a sentence', () => {
  test.each<[string, Change, RegExp]>([
    ['empty', () => '', /11\.asf: .*no :bonedata with bones/],
    [
      'a bone without a name',
      (all) => all.replace('name thorax\n', ''),
      /11\.asf: line \d+, column 1: a bone without a name/,
    ],
    [
      'a length that is none',
      (all) => all.replace(/^length \S+/m, 'length long'),
      /11\.asf: line \d+, column 8: “long” is no finite/,
    ],
    ['a bone without a length', (all) => all.replace(/^length \S+\n/m, ''), /the bone “lowerback” has no length/],
    [
      'a bone that is not there',
      (all) => all.replace('thorax lowerneck', 'thorax tail'),
      /names “tail”, but :bonedata has no such bone/,
    ],
    [
      'a circle',
      (all) => all.replace('root lowerback', 'thorax lowerback'),
      /does not lead from the root to “lowerback”/,
    ],
  ])('%s', (_, change, sentence) => {
    expect(() => prepare(acclaim, skeletonName, change)).toThrow(sentence);
  });

  test('a forearm of no length', () => {
    const folded: Change = (all) =>
      all
        .replace(/(name lwrist\ndirection .*\nlength )\S+/, '$10')
        .replace(/(name lradius\ndirection .*\nlength )\S+/, '$10');
    expect(() => prepare(acclaim, skeletonName, folded)).toThrow(
      /lwrist:end \(leftHand\) lies on lradius \(leftLowerArm\)/,
    );
  });

  test('a million bones', () => {
    const many = Array.from({ length: 1e6 }, (_, i) => `begin\nname b${i}\ndirection 0 1 0\nlength 1\nend\n`).join('');
    expect(() => prepare(acclaim, skeletonName, (all) => all.replace(':hierarchy', `${many}:hierarchy`))).toThrow(
      /more than 2000 bones: not a human skeleton/,
    );
  });
});

describe('a skeleton that is no person’s, or not known, is refused in a sentence', () => {
  const bvh = (change: Change) => () => prepare(walk, walk.motion, change);
  test.each<[string, Change, RegExp]>([
    [
      'legs of three metres',
      (all) =>
        all.replaceAll(
          /(JOINT (?:Left|Right)(?:Leg|Foot)\s*\{\s*OFFSET \S+) (\S+)/g,
          (_, joint, down) => `${joint} ${4 * Number(down)}`,
        ),
      /^someone_walks\.bvh: its unit is unknown, and its body is no person’s when it is scaled .*: An arm span/,
    ],
    [
      'a trunk of no length',
      (all) => all.replace(/(JOINT Neck\s*\{\s*OFFSET) .*/, '$1 0 0 0'),
      /Neck \(neck\) lies on Spine1 \(chest\)/,
    ],
    [
      'a blink',
      (all) => all.replace(/Frames: [\s\S]*/, (rest) => ['Frames: 3', ...rest.split('\n').slice(1, 5)].join('\n')),
      /nothing in it moves as a person for half a second/,
    ],
  ])('%s', (_, change, sentence) => {
    expect(bvh(change)).toThrow(sentence);
  });

  test('a jump is reported, and what lies before and after is kept', () => {
    const { clips, notes } = prepare(walk, walk.motion, unchanged);
    expect(notes).toEqual(['it leaps at frame 39; cut there']);
    expect(clips).toHaveLength(2);
  });
});
