import { deflateSync } from 'node:zlib';
import { describe, expect, onTestFinished, test, vi } from 'vitest';
import { createAvatarMotionWriter } from '../../../src/threepoint/avatar/avatar-motion-writer';
import { checkAvatar } from '../../../src/threepoint/avatar/file/check-avatar';
import { convertToGlb } from '../../../src/threepoint/avatar/file/convert-to-glb';
import { MotionOnlyError } from '../../../src/threepoint/avatar/file/motion-only-error';
import { parseChecked } from '../../../src/threepoint/avatar/load-avatar';
import { builtFbx, wave } from './built-fbx';
import { type FbxNode, fbxBinary, fbxForms, fbxNode, fbxPacked, long } from './fbx-file';
import { partsOf } from './glb';
import { mixamo } from './rig-namings';
import { expectBody, wear } from './worn-body';

const nameOf = mixamo('mixamorig:');
const name = 'person.fbx';
const check = (bytes: ArrayBuffer) => checkAvatar(bytes, { name, supportedCompressions: [] });

describe.each(fbxForms)('FBX as %s', (_, write) => {
  test('is worn: wrists, fingers, palms and head where the wearer’s are', async () => {
    expectBody(wear(await parseChecked(await check(write(builtFbx({ nameOf }))))));
  });

  test('with a camera, a light and a clip is worn', async () => {
    expectBody(wear(await parseChecked(await check(write(builtFbx({ nameOf, turns: wave, studio: true }))))));
  });

  test('is motion where it has bones and their motion alone', async () => {
    await expect(check(write(builtFbx({ nameOf, bare: true, turns: wave })))).rejects.toThrow(MotionOnlyError);
  });

  test('is refused where it has bones alone', async () => {
    await expect(check(write(builtFbx({ nameOf, bare: true })))).rejects.toThrow('nothing that could be seen');
  });

  test('keeps its motion as one clip', async () => {
    const glb = await convertToGlb(write(builtFbx({ nameOf, turns: wave })), name, 'motion');
    const { json } = partsOf(glb);
    const [clip, ...others] = json.animations as { channels: { target: { node: number; path: string } }[] }[];
    expect(others).toEqual([]);
    const moved = clip!.channels.map(({ target }) => `${json.nodes[target.node]!.name} ${target.path}`);
    expect(moved.toSorted()).toEqual(['mixamorig:LeftArm rotation', 'mixamorig:RightForeArm rotation']);
    expect(json.meshes).toBeUndefined();
  });
});

test('a picture inside FBX is on the body, and others see the converted file', async () => {
  vi.spyOn(console, 'warn').mockReturnValue(undefined);
  onTestFinished(() => void vi.restoreAllMocks());
  const picture = Buffer.from(
    'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==',
    'base64',
  );
  const { file } = await check(fbxPacked(builtFbx({ nameOf, picture })));
  const { json, binary } = partsOf(await file.arrayBuffer());
  const [{ bufferView, mimeType }] = json.images as [{ bufferView: number; mimeType: string }];
  const view = json.bufferViews[bufferView]!;
  expect(mimeType).toBe('image/png');
  expect(binary.subarray(view.byteOffset, view.byteOffset! + view.byteLength)).toEqual(picture);
  const [material] = json.materials as { pbrMetallicRoughness: object }[];
  expect(material!.pbrMetallicRoughness).toMatchObject({
    baseColorTexture: { index: 0 },
    baseColorFactor: [1, 1, 1, 1],
  });
});

const mapping = fbxNode('MappingInformationType', ['ByVertice']);
const reference = fbxNode('ReferenceInformationType', ['IndexToDirect']);
const colours = fbxNode('Colors', [Array.from({ length: 4 * 8 * 60 }, () => 0.5)]);
test.each([
  ['without its list is left out', [mapping]],
  ['without the places in its list has them in order', [mapping, reference, colours]],
])('a layer of a mesh %s', async (_, children) => {
  const layer = fbxNode('LayerElementColor', [0], children);
  const withLayer = (nodes: readonly FbxNode[]): readonly FbxNode[] =>
    nodes.map(({ children, ...node }) => ({
      ...node,
      children: node.name === 'Geometry' ? [...children, layer] : withLayer(children),
    }));
  expectBody(wear(await parseChecked(await check(fbxPacked(withLayer(builtFbx({ nameOf })))))));
});

test('an FBX avatar takes motion as GLB', async () => {
  const writer = await createAvatarMotionWriter(fbxPacked(builtFbx({ nameOf })), name);
  expect(writer.extension).toBe('glb');
});

test.each(fbxForms)('names that every object has are left out of FBX as %s', async (_, write) => {
  const odd = ['__proto__', 'constructor', 'toString'].map((called) => fbxNode(called, [1], [fbxNode('a', ['b'])]));
  const inside = (nodes: readonly FbxNode[]): readonly FbxNode[] =>
    nodes.map((node) => ({ ...node, children: node.children.length > 0 ? [...odd, ...inside(node.children)] : [] }));
  expectBody(wear(await parseChecked(await check(write(inside(builtFbx({ nameOf })))))));
});

describe('is refused with a sentence', () => {
  const refused = (bytes: ArrayBuffer) => expect(check(bytes)).rejects;
  const geometry = (...children: readonly FbxNode[]) =>
    builtFbx({ nameOf }).map((node) =>
      node.name === 'Objects'
        ? { ...node, children: [...node.children, fbxNode('Geometry', [long(7), 'Geometry::More', 'Mesh'], children)] }
        : node,
    );

  test('FBX of a version that is not read', async () => {
    const old = new TextEncoder().encode('; FBX 6.1.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 6100\n}\n');
    await refused(old.buffer).toThrow(
      'person.fbx: cannot be read as FBX (is FBX of version 6.1, and 7 is read; save it as FBX 2013 or later)',
    );
  });

  test('a file that is called FBX and is none', async () => {
    await refused(new TextEncoder().encode('hello').buffer).toThrow(
      'person.fbx: cannot be read as FBX (is no FBX file)',
    );
  });

  test('a file that is cut short', async () => {
    await refused(fbxPacked(builtFbx({ nameOf })).slice(0, 5000)).toThrow(/^person\.fbx: .*cut short/);
  });

  test('an array that grows when it is unpacked', { tags: ['full'] }, async () => {
    const bomb = fbxBinary(geometry(fbxNode('Vertices', [[0, 0, 0]])), (bytes) =>
      bytes.length === 24 ? deflateSync(new Uint8Array(2 ** 27)) : deflateSync(bytes),
    );
    await refused(bomb).toThrow('has an array that is longer than it says');
  });

  test('more numbers than a body has', async () => {
    const file = new Uint8Array(fbxBinary(geometry(fbxNode('Vertices', [[0, 0, 0]]))));
    const at = Buffer.from(file.buffer).lastIndexOf('Vertices') + 'Vertices'.length + 1;
    new DataView(file.buffer).setUint32(at, 2 ** 31, true);
    await refused(file.buffer).toThrow('holds more than 20 million numbers');
  });

  test('more packed arrays than are unpacked in a few seconds, before the first one is', async () => {
    const [array, bytes] = [Int32Array.of(1), deflateSync(Int32Array.of(1, 2))];
    const arrays = Array.from({ length: 100_001 }, () => array);
    const many = fbxBinary([fbxNode('Objects', arrays)], () => bytes);
    await refused(many).toThrow('holds more than 100000 packed arrays');
  });

  test('a file of more than 60 MB, before it is read', async () => {
    const large = new Uint8Array(61 * 2 ** 20);
    large.set(new Uint8Array(fbxPacked(builtFbx({ nameOf }))));
    await refused(large.buffer).toThrow('person.fbx: 61 MB; an FBX file may have 60 MB at most');
  });
});
