import { deflateSync } from 'node:zlib';
import { expect, onTestFinished, test, vi } from 'vitest';
import { convertToGlb } from '../../../src/threepoint/avatar/file/convert-to-glb';
import type { SceneParts } from '../../../src/threepoint/avatar/file/fbx/glb-of-scene';
import { createRandom } from '../../../src/threepoint/core/math/random';
import { releaseMemory } from '../../collect-garbage';
import { reportFigures } from '../../reliability/report-figures';
import { mutatedFiles, ReadingCosts } from '../mutated-files';
import { builtFbx } from './built-fbx';
import { type FbxNode, fbxBinary, fbxText } from './fbx-file';
import { partsOf } from './glb';
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

type Write = (nodes: readonly FbxNode[]) => ArrayBuffer;
const forms: readonly Write[] = [fbxText, (all) => fbxBinary(all), (all) => fbxBinary(all, deflateSync)];
const whole = forms.map((write) => write(nodes));
const oddNumbers = [0, -1, 0.5, 1e9, -1e9, 2 ** 31 - 1, 1e300, -1e-300];
const oddNames = ['', '__proto__', 'constructor', 'Objects', 'a', 'Model::', 'Cluster', 'Skin', 'Mesh', 'BlendShape'];

/** Ways to spoil a file: its bytes, or what its nodes say. */
function spoilers(chance: () => number) {
  const below = (end: number) => Math.floor(chance() * end);
  const oneOf = <T>(values: readonly T[]): T => values[below(values.length)]!;
  const spoiledBytes = (file: ArrayBuffer): ArrayBuffer => {
    const bytes = new Uint8Array(file.slice(0));
    // Half of the time in what every file begins with.
    const end = chance() < 0.5 ? Math.min(4000, bytes.length) : bytes.length;
    for (let i = 1 + below(4); i > 0; i--) bytes[below(end)]! ^= 1 << below(8);
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
    const way = below(5);
    if (way === 0) return { ...node, children: node.children.filter(() => chance() < 0.7) };
    if (way === 1)
      return { ...node, properties: node.properties.map((each) => (chance() < 0.5 ? spoiledProperty(each) : each)) };
    if (way === 2) return { ...node, properties: node.properties.slice(1) };
    if (way === 3) return { ...node, children: [...node.children, ...node.children] };
    return { ...node, name: oneOf(oddNames) };
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

test('what is held of a file of several MB with packed arrays is a few times its size', {
  tags: ['full'],
}, async () => {
  const held = (): number => {
    releaseMemory();
    const { heapUsed, arrayBuffers } = process.memoryUsage();
    return heapUsed + arrayBuffers;
  };
  const chance = createRandom(48);
  const turned = Array.from({ length: 30_000 }, () => [chance(), chance(), chance()] as const);
  const large = fbxBinary(
    builtFbx({
      nameOf: mixamo('mixamorig:'),
      turns: { leftUpperArm: turned, rightUpperArm: turned, spine: turned, head: turned },
    }),
    deflateSync,
  );
  expect(large.byteLength).toBeGreaterThan(3e6);
  await convertToGlb(whole[0]!, name, 'motion');
  const before = held();
  const read = await convertToGlb(large, name, 'motion');
  expect(held() - before).toBeLessThan(6 * large.byteLength);
  expect(read.byteLength).toBeGreaterThan(1e6);
});

const files = mutatedFiles(250);

test(`${files} spoiled FBX files are refused in a sentence or read as GLB, each in a moment`, {
  timeout: 3_600_000,
}, async () => {
  // The reader warns of what it passes over.
  vi.spyOn(console, 'warn').mockReturnValue(undefined);
  vi.spyOn(console, 'error').mockReturnValue(undefined);
  onTestFinished(() => void vi.restoreAllMocks());
  const spoil = spoilers(createRandom(20261127));
  const counts = { 'FBX refused': 0, 'FBX read': 0 };
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
    } else {
      expect(partsOf(new Uint8Array(read)).json.nodes.length, `file ${i}`).toBeGreaterThan(0);
      counts['FBX read'] += 1;
    }
  }
  reportFigures('mutated-avatars', { 'FBX files': files, ...counts, ...costs.figures('FBX') });
  expect(costs.longestMs).toBeLessThan(1000);
  // A packed array leaves tables of 130 kB, twice: the garbage of 200 arrays in a small file is hundreds of times its
  // size. What is held is the result, whose arrays are not packed.
  expect(costs.largestMultiple).toBeLessThan(20);
  expect(counts['FBX refused']).toBeGreaterThan(files / 10);
  expect(counts['FBX read']).toBeGreaterThan(files / 10);
});
