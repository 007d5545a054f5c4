// @module-tag full
import { expect, onTestFinished, test, vi } from 'vitest';
import { untrustedAvatarLimits } from '../../../src/threepoint/avatar/file/avatar-limits';
import { checkAvatar } from '../../../src/threepoint/avatar/file/check-avatar';
import { convertToGlb } from '../../../src/threepoint/avatar/file/convert-to-glb';
import type { SceneParts } from '../../../src/threepoint/avatar/file/fbx/glb-of-scene';
import { readGltfMotion } from '../../../src/threepoint/avatar/file/read-gltf-motion';
import { parseChecked } from '../../../src/threepoint/avatar/load-avatar';
import { createRandom } from '../../../src/threepoint/core/math/random';
import { prepareMocap } from '../../../src/threepoint/core/mocap/prepare-mocap';
import { finishWork } from '../../../src/threepoint/core/motion/work';
import { releaseMemory } from '../../collect-garbage.mjs';
import { reportFigures } from '../../reliability/report-figures';
import { choicesBy, mutatedFiles, mutationSeed, ReadingCosts } from '../mutated-files';
import { builtFbx } from './built-fbx';
import { type FbxNode, fbxForms, fbxPacked } from './fbx-file';
import { type GltfJson, partsOf } from './glb';
import { mixamo } from './rig-namings';

const name = 'person.fbx';
const fingers = ['Thumb', 'Index', 'Middle', 'Little'].flatMap((finger) =>
  ['Metacarpal', 'Proximal', 'Intermediate', 'Distal'].flatMap((part) => [
    `left${finger}${part}`,
    `right${finger}${part}`,
  ]),
);
const nodes = builtFbx({
  ...{ nameOf: mixamo('mixamorig:'), without: fingers, studio: true },
  turns: { leftUpperArm: Array.from({ length: 8 }, (_, frame) => [0, 0, -9 * frame] as const) },
});

const allNodes = (all: readonly FbxNode[]): FbxNode[] => all.flatMap((node) => [node, ...allNodes(node.children)]);
const spoilable = allNodes(nodes);

const forms = fbxForms.map(([, write]) => write);
const whole = forms.map((write) => write(nodes));
const oddNumbers = [0, -1, 0.5, 1e9, -1e9, 2 ** 31 - 1, 1e300, -1e-300];
const namesIn = (all: readonly FbxNode[]): string[] =>
  all.flatMap(({ name, children }) => [name, ...namesIn(children)]);
/** Every name of the file, so that one node is taken for another. */
const fileNames = [...new Set(namesIn(nodes))];
const oddNames = ['', '__proto__', 'constructor', 'Objects', 'a', 'Model::', 'Cluster', 'Skin', 'Mesh', 'BlendShape'];

/** Ways to spoil a file: its bytes, or what its nodes say. */
function spoilers(chance: () => number) {
  const { below, oneOf, flipBits } = choicesBy(chance);
  const spoiledBytes = (file: ArrayBuffer): ArrayBuffer => {
    const bytes = new Uint8Array(file.slice(0));
    // Half of the time in what every file begins with.
    flipBits(chance() < 0.5 ? bytes.subarray(0, 4000) : bytes, 1 + below(4));
    return bytes.buffer;
  };
  const spoiledProperty = (property: FbxNode['properties'][number]): FbxNode['properties'][number] => {
    if (typeof property === 'string') return oneOf(oddNames);
    if (typeof property === 'number') return oneOf(oddNumbers);
    if ('long' in property) return { long: Math.trunc(oneOf([0, -1, 1001, 1002, 1050, 2 ** 40])) };
    const list = property.slice(0, below(property.length + 1)) as Int32Array;
    if (list.length > 0 && !(list instanceof BigInt64Array)) list[below(list.length)] = oneOf(oddNumbers);
    return list;
  };
  const spoiledNode = (node: FbxNode): FbxNode => {
    const way = below(8);
    if (way === 0) return { ...node, children: node.children.filter(() => chance() < 0.7) };
    if (way === 1)
      return { ...node, properties: node.properties.map((each) => (chance() < 0.5 ? spoiledProperty(each) : each)) };
    if (way === 2) return { ...node, properties: node.properties.slice(1) };
    if (way === 3) return { ...node, children: [...node.children, ...node.children] };
    if (way === 4) return { ...node, name: oneOf(oddNames) };
    if (way === 5) return { ...node, name: oneOf(fileNames) };
    // A node in the place of another, or inside it.
    const other = oneOf(spoilable);
    return way === 6 ? { ...other, name: node.name } : { ...node, children: [...node.children, other] };
  };
  const spoiled = (node: FbxNode, share: number): FbxNode => {
    const children = node.children.map((child) => spoiled(child, share));
    return chance() < share ? spoiledNode({ ...node, children }) : { ...node, children };
  };
  return (): ArrayBuffer => {
    const way = chance();
    if (way < 0.3) return spoiledBytes(oneOf(whole));
    const file = oneOf(whole);
    if (way < 0.4) return file.slice(0, below(file.byteLength));
    return oneOf(forms)(nodes.map((node) => spoiled(node, 0.003)));
  };
}

test('the memory held for a file of packed arrays is a few times its size', {
  tags: ['full'],
}, async () => {
  const held = (): number => {
    releaseMemory();
    const { heapUsed, arrayBuffers } = process.memoryUsage();
    return heapUsed + arrayBuffers;
  };
  const chance = createRandom(48);
  const turned = Array.from({ length: 30_000 }, () => [chance(), chance(), chance()] as const);
  const large = fbxPacked(
    builtFbx({
      nameOf: mixamo('mixamorig:'),
      turns: { leftUpperArm: turned, rightUpperArm: turned, spine: turned, head: turned },
    }),
  );
  expect(large.byteLength).toBeGreaterThan(3e6);
  await convertToGlb(whole[0]!, name, 'motion');
  const before = held();
  const read = await convertToGlb(large, name, 'motion');
  expect(held() - before).toBeLessThan(6 * large.byteLength);
  expect(read.byteLength).toBeGreaterThan(1e6);
});

const files = mutatedFiles(80);

/** Returns how many numbers of a GLB file are not finite. JSON has no such numbers: they are written as null. */
function unfiniteNumbers({ accessors = [], bufferViews, nodes }: GltfJson, binary: Uint8Array): number {
  const floats = accessors.flatMap(({ componentType, bufferView }) => {
    const { byteOffset = 0, byteLength } = bufferViews[bufferView!]!;
    return componentType === 5126
      ? [...new Float32Array(binary.slice(byteOffset, byteOffset + byteLength).buffer)]
      : [];
  });
  const nulls = JSON.stringify([accessors, nodes]).match(/null/g) ?? [];
  return nulls.length + floats.filter((value) => !Number.isFinite(value)).length;
}

/** Reads a converted file as the page does: the body that is worn, or the motion of a person. */
async function wornOrMoved(bytes: ArrayBuffer, parts: SceneParts): Promise<void> {
  if (parts === 'motion') {
    const { clips } = finishWork(prepareMocap({ name, ...(await readGltfMotion(bytes, name)) }));
    for (const { tracked } of clips) expect(tracked.every(Number.isFinite)).toBe(true);
    return;
  }
  const options = { name, supportedCompressions: [], limits: untrustedAvatarLimits };
  const { vrm } = await parseChecked(await checkAvatar(bytes, options));
  vrm.scene.traverse((node) => {
    node.updateMatrix();
    expect(node.matrix.elements.every(Number.isFinite), node.name).toBe(true);
  });
}

test(`${files} spoiled FBX files are refused in a sentence or read as GLB, each at once`, {
  timeout: 3_600_000,
}, async () => {
  // The reader warns of what it passes over.
  vi.spyOn(console, 'warn').mockReturnValue(undefined);
  vi.spyOn(console, 'error').mockReturnValue(undefined);
  onTestFinished(() => void vi.restoreAllMocks());
  const spoil = spoilers(createRandom(mutationSeed));
  const counts = { 'FBX refused': 0, 'FBX read': 0, 'FBX worn or moved': 0 };
  // What the reader holds once it has been loaded is no multiple of a file.
  await convertToGlb(whole[0]!, name, 'body');
  const costs = new ReadingCosts(releaseMemory);
  for (let i = 0; i < files; i++) {
    const file = spoil();
    const parts: SceneParts = i % 2 === 0 ? 'body' : 'motion';
    const read = await costs.measure(file.byteLength, () => convertToGlb(file, name, parts));
    if (read instanceof Error) {
      expect(read.message, `file ${i}`).toMatch(/^person\.fbx: cannot be read as FBX \(.+\)$/s);
      counts['FBX refused'] += 1;
      continue;
    }
    counts['FBX read'] += 1;
    const { json, binary } = partsOf(read);
    expect(json.nodes.length, `file ${i}`).toBeGreaterThan(0);
    expect(unfiniteNumbers(json, binary), `file ${i}`).toBe(0);
    const worn = await costs.measure(file.byteLength, () => wornOrMoved(read, parts));
    if (!(worn instanceof Error)) counts['FBX worn or moved'] += 1;
    else
      expect(worn.message, `file ${i}: ${worn.stack}`).toMatch(
        /^person\.fbx: (?!.*(undefined|Cannot read|is not a function))/s,
      );
  }
  reportFigures('mutated-avatars', { 'FBX files': files, ...counts, ...costs.figures('FBX') });
  expect(costs.longestMs).toBeLessThan(1000);
  // A packed array leaves tables of 130 kB, twice: the garbage of 200 arrays in a small file is hundreds of times its
  // size. What is held is the result, whose arrays are not packed.
  expect(costs.largestMultiple).toBeLessThan(20);
  expect(counts['FBX refused']).toBeGreaterThan(files / 10);
  expect(counts['FBX read']).toBeGreaterThan(files / 10);
});
