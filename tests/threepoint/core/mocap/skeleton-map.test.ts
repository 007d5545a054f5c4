import { describe, expect, test } from 'vitest';
import { isSkeletonMap } from '../../../../src/threepoint/core/mocap/is-skeleton-map';
import { acclaim } from '../../../../src/threepoint/core/mocap/mocap-rules.json';
import { prepareMocap } from '../../../../src/threepoint/core/mocap/prepare-mocap';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { goldenMocap, sourceOf } from './golden-mocap';

const folded = goldenMocap.find(({ motion }) => motion === 'folded_1.bvh')!;
const map = JSON.parse(folded.files['map.json']!);
const withMap = (text: string) =>
  finishWork(prepareMocap(sourceOf({ ...folded, files: { ...folded.files, 'map.json': text } })));
const changed = (change: Record<string, unknown>) => () => withMap(JSON.stringify({ ...map, ...change }));

describe('a map of a skeleton', () => {
  test('is known from a recording and from what is no JSON', () => {
    expect(isSkeletonMap(folded.files['map.json']!)).toBe(true);
    expect(isSkeletonMap('{"format": "threepoint-recording", "joints": {}}')).toBe(false);
    expect(isSkeletonMap('{"photos": []}')).toBe(false);
    expect(isSkeletonMap('{"joints"')).toBe(false);
  });

  test('takes the rest of an AMC from another AMC of the same skeleton', () => {
    const source = sourceOf(goldenMocap.find(({ motion }) => motion.endsWith('.amc'))!);
    if (source.format !== 'amc') throw new Error('expected an AMC');
    const atRest = source.text.replace(
      /^([a-z]+) .*$/gm,
      (line, bone) => bone + ' 0'.repeat(line.split(' ').length - 1),
    );
    const text = JSON.stringify({ ...acclaim, restFrame: { file: 'rest.amc' } });
    const rest = { name: 'rest.amc', text: atRest };
    const [own] = finishWork(prepareMocap(source)).clips;
    const [mapped] = finishWork(prepareMocap({ ...source, map: { name: 'map.json', text }, rest })).clips;
    for (const [i, value] of mapped!.truth.entries()) expect(value).toBeCloseTo(own!.truth[i]!, 5);
  });

  test.each<[string, () => unknown, RegExp]>([
    ['no JSON', () => withMap('{'), /map\.json: no valid JSON: /],
    ['no map', () => withMap('[]'), /map\.json: expected an object with “joints”/],
    ['an unknown key', changed({ bones: 1 }), /map\.json: “bones” is not known/],
    ['a joint that is missing', changed({ joints: { hips: 'a' } }), /map\.json: joints\.chest is missing/],
    ['a joint that is none of ours', changed({ joints: { ...map.joints, tail: 'a' } }), /joints\.tail is none of ours/],
    [
      'a joint that the file lacks',
      changed({ joints: { ...map.joints, head: 'Kopf' } }),
      /^folded_1\.bvh: no joint “Kopf”/,
    ],
    [
      'a rotation of a joint that is not tracked',
      changed({ rotations: { neck: 'bip_Head' } }),
      /map\.json: rotations\.neck is none of head, leftHand, rightHand/,
    ],
    ['a rotation of no joint', changed({ rotations: { head: 7 } }), /rotations\.head should be the name of a joint/],
    ['rotations in a list', changed({ rotations: ['bip_Head'] }), /map\.json: “rotations” should be an object/],
    [
      'a rotation of a joint that the file lacks',
      changed({ rotations: { head: 'Kopf' } }),
      /^folded_1\.bvh: no joint “Kopf”, which the map “.*” names as the rotation of head/,
    ],
    ['one axis for two', changed({ up: '-z' }), /“up” -z and “forward” \+z are one axis/],
    ['an axis that is none', changed({ up: 'north' }), /“up” should be one of \+x/],
    ['a scale of nothing', changed({ scale: 0 }), /“scale” should be a number above zero/],
    ['two rests', changed({ restFrame: 1 }), /either “restFrame” or “restPose”/],
    [
      'a frame beyond the end',
      changed({ restPose: undefined, restFrame: 999 }),
      /restFrame 999, but there are 76 frames/,
    ],
    [
      'a frame of another file',
      changed({ restPose: undefined, restFrame: { file: 'a.bvh' } }),
      /here it is the number of a frame/,
    ],
    [
      'angles of too many axes',
      changed({ restPose: { bip_Hips: [1] } }),
      /restPose gives bip_Hips 1 angles, the file 3/,
    ],
    ['no rest where bones are folded', changed({ restPose: undefined }), /the rest pose is no T-pose/],
  ])('with %s is refused in a sentence', (_, prepare, sentence) => {
    expect(prepare).toThrow(sentence);
  });
});
