import type { Object3D } from 'three';
import { expect, onTestFinished, test, vi } from 'vitest';
import { untrustedAvatarLimits } from '../../../src/threepoint/avatar/file/avatar-limits';
import { checkAvatar } from '../../../src/threepoint/avatar/file/check-avatar';
import { parseChecked } from '../../../src/threepoint/avatar/load-avatar';
import { createRandom } from '../../../src/threepoint/core/math/random';
import { reportFigures } from '../../reliability/report-figures';
import { choicesBy, containersIn, mutatedFiles, mutationSeed, ReadingCosts } from '../mutated-files';
import { builtRig } from './built-rig';
import { changed, type GltfJson, glbOf, mannequin, partsOf, pngHeader, withPictures } from './glb';
import { vroid } from './rig-namings';
import { smallOldVrm, smallVrm } from './small-vrms';

const name = 'person.vrm';
const files = mutatedFiles(1000);

/** Small files mostly: of a large one the Khronos validator reads every number. */
const originals: readonly ArrayBuffer[] = [
  ...[builtRig({ nameOf: vroid }), withPictures(1, pngHeader(64, 64), builtRig({ nameOf: vroid }))],
  ...[smallVrm, smallVrm, smallVrm, smallVrm, smallOldVrm, smallOldVrm, smallOldVrm],
  mannequin(),
];

const oddValues: readonly unknown[] = [
  ...[null, true, '', '__proto__', [], {}, [[]], [null], -1, 0, 0.5, 1e9, 2 ** 31, 2 ** 53, 1e308, -1e-320],
  ...['VEC3', 'MAT4', 5120, 5126, 'data:,', 'KHR_draco_mesh_compression', { toString: null }],
];

/** Ways to spoil a file. */
function spoilers(chance: () => number) {
  const { below, oneOf, flipBits } = choicesBy(chance);
  const copyOf = (file: ArrayBuffer) => new Uint8Array(file.slice(0));
  const lengthOfJson = (bytes: Uint8Array) => new DataView(bytes.buffer).getUint32(12, true);

  function withBytes(file: ArrayBuffer, from: number, to: number): ArrayBuffer {
    const bytes = copyOf(file);
    flipBits(bytes.subarray(from, to), 1 + below(4));
    return bytes.buffer;
  }
  function spoilJson(json: GltfJson): void {
    // Half of the time what the extensions say, which the Khronos validator does not read.
    const inside = chance() < 0.5 ? containersIn(json.extensions) : [];
    const container = oneOf(inside.length > 0 ? inside : containersIn(json)) as Record<string, unknown>;
    const keys = Object.keys(container);
    const key = keys.length > 0 ? oneOf(keys) : 'extras';
    const way = below(4);
    if (way === 0) delete container[key];
    else if (way === 1) container[key] = structuredClone(oneOf(containersIn(json)));
    else if (way === 2 && typeof container[key] === 'number') container[key] = container[key] + below(200) - 100;
    else container[key] = structuredClone(oneOf(oddValues));
  }
  const ways: readonly ((file: ArrayBuffer) => ArrayBuffer)[] = [
    (file) => withBytes(file, 0, 28),
    (file) => withBytes(file, 20, 20 + lengthOfJson(copyOf(file))),
    (file) => withBytes(file, 20 + lengthOfJson(copyOf(file)), file.byteLength),
    (file) => file.slice(0, below(file.byteLength)),
    ...Array.from({ length: 6 }, () => (file: ArrayBuffer) => {
      const { json, binary } = partsOf(file);
      for (let i = 1 + below(3); i > 0; i--) spoilJson(json);
      return glbOf(json, binary);
    }),
  ];
  return () => oneOf(ways)(oneOf(originals));
}

const isFinitePlace = (node: Object3D): boolean => {
  node.updateMatrix();
  return [...node.matrix.elements].every(Number.isFinite);
};

test.each([
  ['VRM 1.0', smallVrm],
  ['VRM 0.x', smallOldVrm],
])('a small %s is read', async (_, file) => {
  const { vrm } = await parseChecked(await checkAvatar(file, { name, supportedCompressions: [] }));
  expect(vrm.humanoid.getRawBoneNode('head')).not.toBeNull();
});

interface SpringExtensions {
  readonly VRMC_springBone?: {
    readonly colliders: readonly { readonly shape: { readonly sphere: { offset: unknown } } }[];
  };
  readonly VRM?: {
    readonly secondaryAnimation: {
      readonly colliderGroups: readonly { readonly colliders: readonly { offset: unknown }[] }[];
    };
  };
}

/** The springs of a file with a value in place of the offset of its collider. */
const withOffset = (file: ArrayBuffer, offset: unknown) =>
  changed(({ extensions }) => {
    const { VRMC_springBone: springs, VRM: old } = extensions as SpringExtensions;
    const collider = springs?.colliders[0]?.shape.sphere ?? old?.secondaryAnimation.colliderGroups[0]?.colliders[0];
    if (offset !== undefined) collider!.offset = offset;
  }, file);

test.each([
  ['VRM 1.0', smallVrm, [{ toString: null }, 0, 0]],
  ['VRM 1.0', smallVrm, ['a', 0, 0]],
  ['VRM 0.x', smallOldVrm, { x: { toString: null }, y: 0, z: 0 }],
  ['VRM 0.x', smallOldVrm, { x: 'a', y: 0, z: 0 }],
])('the springs of a %s whose numbers are none are left out', async (_, file, offset) => {
  const read = async (bytes: ArrayBuffer) =>
    (await parseChecked(await checkAvatar(bytes, { name, supportedCompressions: [] }))).vrm.springBoneManager;
  expect((await read(withOffset(file, undefined)))!.joints.size).toBeGreaterThan(0);
  expect((await read(withOffset(file, offset)))?.joints.size ?? 0).toBe(0);
});

test('spoiled avatar files are refused in a sentence or read as finite bodies, in a moment', {
  tags: ['full'],
  timeout: 3_600_000,
}, async () => {
  // The reader warns of what it passes over.
  vi.spyOn(console, 'warn').mockReturnValue(undefined);
  onTestFinished(() => void vi.restoreAllMocks());
  const spoil = spoilers(createRandom(mutationSeed));
  const counts = { refused: 0, 'refused by the reader': 0, read: 0 };
  const [checking, building] = [new ReadingCosts(), new ReadingCosts()];
  for (let i = 0; i < files; i++) {
    const bytes = spoil();
    const size = bytes.byteLength;
    const options = { name, supportedCompressions: [], limits: untrustedAvatarLimits };
    const checked = await checking.measure(size, () => checkAvatar(bytes, options));
    if (checked instanceof Error) {
      expect(checked.message, `file ${i}`).toMatch(/^person\.vrm: /);
      counts.refused += 1;
      continue;
    }
    const read = await building.measure(size, () => parseChecked(checked));
    if (read instanceof Error) {
      expect(read.message, `file ${i}: ${read.stack}`).toMatch(/^person\.vrm: /);
      counts['refused by the reader'] += 1;
      continue;
    }
    counts.read += 1;
    read.vrm.scene.traverse((node) => expect(isFinitePlace(node), `file ${i}: ${node.name}`).toBe(true));
  }
  reportFigures('mutated-avatars', { files, ...counts, ...checking.figures('check'), ...building.figures('body') });
  expect(Math.max(checking.longestMs, building.longestMs)).toBeLessThan(1000);
  expect(Math.max(checking.largestMultiple, building.largestMultiple)).toBeLessThan(3);
  expect(counts.refused).toBeGreaterThan(files / 10);
  expect(counts.read).toBeGreaterThan(files / 50);
});
