import { Euler, Matrix4, Quaternion, Vector3 } from 'three';
import { expect, test } from 'vitest';
import { checkAvatar } from '../../../src/threepoint/avatar/file/check-avatar';
import { convertToGlb } from '../../../src/threepoint/avatar/file/convert-to-glb';
import { readGltfMotion } from '../../../src/threepoint/avatar/file/read-gltf-motion';
import type { BoneName } from '../../../src/threepoint/core/humanoid/bones';
import { prepareMocap, readTruthMotion } from '../../../src/threepoint/core/mocap/prepare-mocap';
import { truthJoints } from '../../../src/threepoint/core/mocap/skeleton-map';
import { finishWork } from '../../../src/threepoint/core/motion/work';
import { type BoneTurns, builtFbx } from './built-fbx';
import { rigJoints } from './built-rig';
import { fbxBinary, fbxPacked, fbxText } from './fbx-file';
import { changed, type GltfJson, glbOf, partsOf } from './glb';
import { mixamo } from './rig-namings';

const frames = 90;
const every = (angles: (frame: number) => readonly [number, number, number]) => Array.from({ length: frames }, (_, frame) => angles(frame)); // biome-ignore format: one thought
const turns: BoneTurns = {
  spine: every((frame) => [8 * Math.sin(frame / 20), 0, 0]),
  leftUpperArm: every((frame) => [0, 0, -60 + 20 * Math.sin(frame / 15)]),
  rightUpperArm: every((frame) => [0, 0, 50 * Math.sin(frame / 12)]),
  rightLowerArm: every((frame) => [0, 40 + 30 * Math.sin(frame / 10), 0]),
};
const hips = every((frame) => [0, 0.92, 0.004 * frame]);
const options = { nameOf: mixamo('mixamorig:'), turns, hips };

/** The place of a joint in a frame of the clip, floor frame [m]: the floor's person faces −Z, the file's +Z. */
function placeOf(bone: BoneName, frame: number): Vector3 {
  const joints = rigJoints({});
  const worldOf = (name: BoneName): Matrix4 => {
    const { parent, at } = joints.find((joint) => joint.bone === name)!;
    const from = parent ? joints.find((joint) => joint.bone === parent)!.at : new Vector3();
    const offset = name === 'hips' ? new Vector3(...hips[frame]!) : at.clone().sub(from);
    const [x, y, z] = (turns[name]?.[frame] ?? [0, 0, 0]).map((degrees) => (degrees * Math.PI) / 180);
    const turn = new Quaternion().setFromEuler(new Euler(x, y, z, 'ZYX'));
    const own = new Matrix4().compose(offset, turn, new Vector3(1, 1, 1));
    return parent ? worldOf(parent).multiply(own) : own;
  };
  const { x, y, z } = new Vector3().setFromMatrixPosition(worldOf(bone));
  return new Vector3(-x, y, -z);
}

async function expectTruth(bytes: ArrayBuffer, name: string): Promise<void> {
  const source = { name, ...(await readGltfMotion(bytes, name)) };
  const { motion } = finishWork(readTruthMotion(source));
  expect(motion.rateHz).toBe(60);
  for (let frame = 0; frame < frames; frame += 7) {
    for (const bone of ['hips', 'head', 'leftHand', 'rightLowerArm', 'rightHand', 'leftFoot'] as const) {
      const at = 3 * (2 * frame * truthJoints.length + truthJoints.indexOf(bone));
      const read = new Vector3(...motion.positions.subarray(at, at + 3));
      expect(read.distanceTo(placeOf(bone, frame)), `${bone} in frame ${frame} [m]`).toBeLessThan(1e-3);
    }
  }
  const { clips } = finishWork(prepareMocap(source));
  expect(clips.map(({ frameCount }) => frameCount)).toEqual([2 * (frames - 1) + 1]);
}

test.each([
  ['text', fbxText(builtFbx(options))],
  ['bytes', fbxPacked(builtFbx(options))],
  ['bones alone', fbxBinary(builtFbx({ ...options, bare: true }))],
])('motion in FBX as %s is read as it was written', async (_, bytes) => {
  await expectTruth(bytes, 'wave.fbx');
});

test('the clip of a GLB, the longest of several, is read too', async () => {
  const glb = await convertToGlb(fbxBinary(builtFbx(options)), 'wave.fbx', 'motion');
  await expectTruth(glb, 'wave.glb');
  const { json, binary } = partsOf(glb);
  json.buffers[0]!.uri = `data:application/octet-stream;base64,${Buffer.from(binary).toString('base64')}`;
  await expectTruth(new TextEncoder().encode(JSON.stringify(json)).buffer, 'wave.gltf');
  const several = changed((json: GltfJson) => {
    const [clip] = json.animations as { channels: object[]; samplers: object[] }[];
    json.accessors.push({ ...json.accessors[0]!, count: 1, max: [0] });
    const short = { input: json.accessors.length - 1, output: json.accessors.length - 1 };
    json.animations = [
      { name: 'none', channels: [], samplers: [short] },
      { ...clip, name: 'wave' },
    ];
  }, glb);
  const { notes } = finishWork(prepareMocap({ name: 'wave.glb', ...(await readGltfMotion(several, 'wave.glb')) }));
  expect(notes).toContain('it has 2 clips; the longest, “wave”, is shown');
});

test('a skin that was bound in T-pose counts as rest where the file shows another pose', async () => {
  const glb = await convertToGlb(fbxBinary(builtFbx(options)), 'wave.fbx', 'motion');
  const posed = changed((json) => {
    const arm = json.nodes.find(({ name }) => name === 'mixamorig:LeftArm') as { rotation?: number[] };
    arm.rotation = [0, 0, -Math.SQRT1_2, Math.SQRT1_2];
  }, glb);
  await expectTruth(posed, 'wave.glb');
});

test('a skin bound to chain ends a hundredfold off is read all the same', async () => {
  const glb = await convertToGlb(fbxBinary(builtFbx(options)), 'wave.fbx', 'motion');
  const { json, binary } = partsOf(glb);
  const skin = json.skins[0]! as { joints: number[]; inverseBindMatrices: number };
  const { byteOffset = 0 } = json.bufferViews[json.accessors[skin.inverseBindMatrices]!.bufferView!]!;
  for (const [i, joint] of skin.joints.entries()) {
    const node = json.nodes[joint]!;
    if (node.children || !/Thumb|Index|Middle|Ring|Pinky/.test(node.name)) continue;
    node.name += '_end';
    for (const row of [12, 13, 14]) {
      const at = byteOffset + 64 * i + 4 * row;
      binary.writeFloatLE(100 * binary.readFloatLE(at), at);
    }
  }
  await expectTruth(glbOf(json, binary), 'wave.glb');
});

/** Puts each buffer view of a file into a buffer of its own, as data URLs. */
function withDataUrls(bytes: ArrayBuffer): GltfJson {
  const { json, binary } = partsOf(bytes);
  Object.assign(json, {
    buffers: json.bufferViews.map(({ byteOffset = 0, byteLength }) => ({
      byteLength,
      uri: `data:application/octet-stream;base64,${binary.subarray(byteOffset, byteOffset + byteLength).toString('base64')}`,
    })),
  });
  for (const [i, view] of json.bufferViews.entries()) Object.assign(view, { buffer: i, byteOffset: 0 });
  return json;
}

test.each([
  ['glTF as text', (json: GltfJson) => new TextEncoder().encode(JSON.stringify(json)).buffer, 'wave.gltf'],
  ['GLB', (json: GltfJson) => glbOf(json, Buffer.alloc(0)), 'wave.glb'],
] as const)('numbers in data URLs of a %s file are read', async (_, write, name) => {
  const glb = await convertToGlb(fbxBinary(builtFbx(options)), 'wave.fbx', 'motion');
  await expectTruth(write(withDataUrls(glb)), name);
});

test('numbers that are not base64 are refused in a sentence', async () => {
  const buffers = [{ uri: 'data:application/octet-stream;base64,%%%', byteLength: 4 }];
  const text = new TextEncoder().encode(JSON.stringify({ buffers }));
  await expect(readGltfMotion(text.buffer, 'wave.gltf')).rejects.toThrow('wave.gltf: its numbers are not base64');
});

test('a body whose numbers and pictures are in data URLs is read as the body itself', async () => {
  const plain = await checkAvatar(
    changed(() => undefined),
    { name: 'a.vrm', supportedCompressions: [] },
  );
  const text = new TextEncoder().encode(JSON.stringify(withDataUrls(changed(() => undefined))));
  const read = await checkAvatar(text.buffer, { name: 'a.gltf', supportedCompressions: [] });
  const [one, other] = await Promise.all(
    [plain, read].map(async ({ file }) => partsOf(await file.arrayBuffer()).json.accessors),
  );
  expect(other).toEqual(one);
  const pictured = changed((json) => {
    json.images = [{ uri: 'data:image/png;base64,iVBORw0KGgo=' }];
  });
  const { json, binary } = partsOf(await convertToGlb(pictured, 'a.vrm', 'body'));
  const { bufferView, ...image } = json.images![0]!;
  expect(image).toEqual({ mimeType: 'image/png' });
  const { byteOffset = 0, byteLength } = json.bufferViews[bufferView!]!;
  expect(binary.subarray(byteOffset, byteOffset + byteLength).toString('latin1')).toBe('\x89PNG\r\n\x1a\n');
});

test('numbers in another file are refused in a sentence', async () => {
  const text = new TextEncoder().encode(JSON.stringify({ buffers: [{ uri: 'wave.bin', byteLength: 4 }] }));
  await expect(readGltfMotion(text.buffer, 'wave.gltf')).rejects.toThrow('wave.gltf: its numbers are in other files');
});

test('a file without a clip is refused in a sentence', async () => {
  const glb = await readGltfMotion(
    await convertToGlb(fbxBinary(builtFbx({ nameOf: options.nameOf })), 'a.fbx', 'motion'),
    'a.glb',
  );
  expect(() => finishWork(prepareMocap({ name: 'a.glb', ...glb }))).toThrow('a.glb: there is no animation in it');
});
