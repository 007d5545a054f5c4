import fc from 'fast-check';
import { actorFrame, defaultCalibration, parseRecording, writeRecording } from 'threepoint/core';
import { expect, test } from 'vitest';
import { readGltfMotion } from '../../../../src/threepoint/avatar/file/read-gltf-motion';
import { type MocapSource, prepareMocap } from '../../../../src/threepoint/core/mocap/prepare-mocap';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { writeVrma } from '../../../../src/threepoint/core/motion/write-vrma';
import { isNightly } from '../../../nightly';
import { builtFbx } from '../../avatar/built-fbx';
import { type FbxNode, fbxBinary, fbxText } from '../../avatar/fbx-file';
import { glbOf, partsOf } from '../../avatar/glb';
import { mixamo } from '../../avatar/rig-namings';
import { seed } from '../arbitraries';
import { actingPerson, bytesOf, firstFrames } from '../motion/moved-person';
import { goldenMocap, sourceOf } from './golden-mocap';
import { madeBvh } from './made-bvh';

/** The largest distance from the origin in what is read [m]. */
const limit = 1000;
const sizes = [1e6, 1e9, 1e15, 1e19, 1e38, 1e60, 1e100, 1e308];
/** Draws a number that no motion of a person holds, and which of a file's numbers it replaces. */
const change = fc.record({
  huge: fc.constantFrom(...sizes, ...sizes.map((size) => -size)),
  place: fc.integer({ min: 0, max: 2 ** 30 }),
});
type Change = typeof change extends fc.Arbitrary<infer Value> ? Value : never;

/** Replaces a number of a text. */
function textWith(text: string, { huge, place }: Change): string {
  const found = [...text.matchAll(/(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])/g)];
  const { index, 0: word } = found[place % found.length]!;
  return text.slice(0, index) + huge + text.slice(index + word.length);
}

const frames = 40;
const angles = Array.from({ length: frames }, (_, frame) => [0, 0, -frame] as const);
const nodes = builtFbx({
  nameOf: mixamo('mixamorig:'),
  turns: { leftUpperArm: angles, spine: angles.map(() => [1, 0, 0] as const) },
  hips: angles.map(() => [0, 0.92, 0] as const),
});

/** Replaces a number of an FBX file, of a property or a list. */
function nodesWith({ huge, place }: Change): readonly FbxNode[] {
  let count = 0;
  const replace = (target: number | null) => {
    count = 0;
    const visit = (node: FbxNode): FbxNode => ({
      ...node,
      properties: node.properties.map((property) => {
        if (typeof property === 'number') return count++ === target ? huge : property;
        if (!(property instanceof Float32Array || Array.isArray(property))) return property;
        const at = target === null ? -1 : target - count;
        count += property.length;
        return at >= 0 && at < property.length
          ? (Float64Array.from(property).map((value, i) => (i === at ? huge : value)) as unknown as number[])
          : property;
      }),
      children: node.children.map(visit),
    });
    return nodes.map(visit);
  };
  replace(null);
  return replace(place % count);
}

/** Replaces a number of a GLB file: half of the time of its description, else of its lists in single precision. */
function glbWith(file: Uint8Array, { huge, place }: Change): ArrayBuffer {
  const { json, binary } = partsOf(file);
  if (place % 2 === 0) return glbOf(JSON.parse(textWith(JSON.stringify(json), { huge, place: place >> 1 })), binary);
  const bytes = Buffer.from(binary);
  bytes.writeFloatLE(Math.fround(huge), 4 * ((place >> 1) % (bytes.length >> 2)));
  return glbOf(json, bytes);
}

const vrma = bytesOf(writeVrma(firstFrames(actingPerson(1).motion, frames)));
const glb = new Uint8Array(
  await (await import('../../../../src/threepoint/avatar/file/convert-to-glb')).convertToGlb(
    fbxBinary(nodes),
    'a.fbx',
    'motion',
  ),
);
const acclaim = sourceOf(goldenMocap.find((golden) => golden.motion.endsWith('.amc'))!);
const bvh = madeBvh({ frames });
const gltf = async (name: string, bytes: ArrayBuffer): Promise<MocapSource> => ({
  name,
  ...(await readGltfMotion(bytes, name)),
});
const recording = writeRecording({
  device: 'actor',
  rateHz: 60,
  calibration: defaultCalibration,
  frames: Array.from({ length: frames }, (_, i) => actorFrame(i / 60, defaultCalibration)),
});

/** Reads a file and returns all positions in it [m]. */
const positionsIn = async (source: MocapSource | Promise<MocapSource>): Promise<number[]> =>
  finishWork(prepareMocap(await source)).clips.flatMap(({ tracked, truth, calibration }) => {
    expect(Object.values(calibration).every(Number.isFinite)).toBe(true);
    return [...tracked, ...truth.filter((value) => !Number.isNaN(value))];
  });

const formats: readonly (readonly [string, (change: Change) => Promise<number[]> | number[]])[] = [
  ['bvh', (drawn) => positionsIn({ format: 'bvh', name: 'wave.bvh', text: textWith(bvh, drawn) })],
  [
    'amc',
    (drawn) =>
      positionsIn({
        ...acclaim,
        name: 'wave.amc',
        rateHz: 60,
        text: textWith((acclaim as { text: string }).text, drawn),
      } as MocapSource),
  ],
  [
    'asf',
    (drawn) => {
      const { skeleton } = acclaim as MocapSource & { format: 'amc' };
      return positionsIn({
        ...acclaim,
        name: 'wave.amc',
        rateHz: 60,
        skeleton: { name: 'wave.asf', text: textWith(skeleton.text, drawn) },
      } as MocapSource);
    },
  ],
  ['fbx as text', (drawn) => positionsIn(gltf('wave.fbx', fbxText(nodesWith(drawn))))],
  ['fbx', (drawn) => positionsIn(gltf('wave.fbx', fbxBinary(nodesWith(drawn))))],
  ['glb', (drawn) => positionsIn(gltf('wave.glb', glbWith(glb, drawn)))],
  ['vrma', (drawn) => positionsIn(gltf('wave.vrma', glbWith(vrma, drawn)))],
  [
    'recording',
    (drawn) =>
      [...parseRecording(textWith(recording, drawn)).frames].flatMap(({ head, leftHand, rightHand }) =>
        [head, leftHand, rightHand].flatMap((pose) => (pose ? Object.values(pose.position) : [])),
      ),
  ],
];

test.each(formats)(
  'a huge number in %s is refused in a sentence or becomes motion within a kilometre',
  async (format, read) => {
    let [refused, within] = [0, 0];
    await fc.assert(
      fc.asyncProperty(change, async (drawn) => {
        let positions: number[] = [];
        try {
          positions = await read(drawn);
        } catch (error) {
          const { message, stack } = error as Error;
          expect(message, stack).toMatch(format === 'recording' ? /recording/ : /^wave\.\w+: /);
          expect(message, stack).not.toMatch(/undefined|is not a function|NaN|Infinity|Invalid|Cannot|its parts/);
          refused += 1;
          return;
        }
        within += 1;
        for (const value of positions) if (!(Math.abs(value) <= limit + 10)) expect(value).toBe(limit);
      }),
      { seed, numRuns: isNightly ? 3000 : 60 },
    );
    expect(refused).toBeGreaterThan(3);
    expect(within).toBeGreaterThan(0);
  },
);

test('an offset, an angle and a place without end are named with their line or joint', () => {
  const prepare = (text: string) => () => finishWork(prepareMocap({ format: 'bvh', name: 'wave.bvh', text }));
  for (const huge of ['1e60', '1e100', '1e308', '-1e308'])
    expect(prepare(bvh.replace(/OFFSET \S+ \S+/, `OFFSET 0 ${huge}`))).toThrow(
      `wave.bvh: line 4, column 11: “${huge}” is too large`,
    );
  expect(prepare(bvh.replace(/(Frame Time.*\n)\S+/, '$1900000'))).toThrow(
    /^wave\.bvh: the joint Hips \(hips\) is 9000 m from the origin in frame 1/,
  );
});

test('a clip that lasts hours with few keys is refused before its frames are read', async () => {
  const turns = { leftUpperArm: angles };
  const slow = fbxBinary(builtFbx({ nameOf: mixamo('mixamorig:'), turns, rateHz: frames / 8000 }));
  const source = await gltf('slow.fbx', slow);
  const started = process.cpuUsage();
  expect(() => finishWork(prepareMocap(source))).toThrow(
    'slow.fbx: it lasts 7800 s with 40 keys; motion has one in 10 s at least',
  );
  expect(process.cpuUsage(started).user / 1000).toBeLessThan(500);
});
