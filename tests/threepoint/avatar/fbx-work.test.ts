import { describe, expect, onTestFinished, test, vi } from 'vitest';
import { convertToGlb } from '../../../src/threepoint/avatar/file/convert-to-glb';
import type { SceneParts } from '../../../src/threepoint/avatar/file/fbx/glb-of-scene';
import { builtFbx, wave } from './built-fbx';
import { type FbxNode, fbxForms, fbxNode, long } from './fbx-file';
import { mixamo } from './rig-namings';

const nameOf = mixamo('mixamorig:');
const name = 'person.fbx';

const count = 20_000;
const list = (value: (i: number) => number, length = count) => Int32Array.from({ length }, (_, i) => value(i));
const ids = (first: number, length: number) => Array.from({ length }, (_, i) => long(first + i));
const connection = (from: number, to: number, ...as: string[]) => fbxNode('C', ['OO', long(from), long(to), ...as]);
const changed = (nodes: readonly FbxNode[], change: (node: FbxNode) => FbxNode): readonly FbxNode[] =>
  nodes.map((node) => change({ ...node, children: changed(node.children, change) }));
const inNode = (wanted: string, change: (children: readonly FbxNode[], node: FbxNode) => readonly FbxNode[]) =>
  changed(builtFbx({ nameOf, turns: wave, hips: wave.leftUpperArm }), (node) =>
    node.name === wanted ? { ...node, children: change(node.children, node) } : node,
  );
const withList = (wanted: string, called: string, values: FbxNode['properties'][number]) =>
  inNode(wanted, (children) => [...children.filter((child) => child.name !== called), fbxNode(called, [values])]);
const withObjects = (objects: readonly FbxNode[], connections: readonly FbxNode[]) =>
  changed(builtFbx({ nameOf, turns: wave }), (node) => {
    const more = node.name === 'Objects' ? objects : node.name === 'Connections' ? connections : [];
    return { ...node, children: [...node.children, ...more] };
  });
const keys = (times: (i: number) => number, values: (i: number) => number, length = count) =>
  inNode('AnimationCurve', () => [
    fbxNode('KeyTime', [BigInt64Array.from({ length }, (_, i) => BigInt(times(i)))]),
    fbxNode('KeyValueFloat', [Float32Array.from({ length }, (_, i) => values(i))]),
  ]);
const idOf = (nodes: readonly FbxNode[], kind: string, type: string): number => {
  const objects = nodes.find((node) => node.name === 'Objects')!.children;
  const found = objects.find((node) => node.name === kind && node.properties[2] === type)!;
  return (found.properties[0] as { long: number }).long;
};
const plain = builtFbx({ nameOf, turns: wave });
const geometry = idOf(plain, 'Geometry', 'Mesh');
const [skin, bone] = [idOf(plain, 'Deformer', 'Skin'), idOf(plain, 'Model', 'LimbNode')];
const models = (length: number) =>
  ids(50_000, length).map((id) => fbxNode('Model', [id, 'Model::a', 'LimbNode'], [fbxNode('Version', [1])]));
const times = BigInt64Array.from({ length: 40 }, (_, i) => BigInt(i * 1_539_538_600));
const cases: readonly (readonly [string, SceneParts, readonly FbxNode[], RegExp])[] = [
  [
    'angles that are times',
    'motion',
    inNode('AnimationCurve', ([keyTime]) => [keyTime!, { ...keyTime!, name: 'KeyValueFloat' }]),
    /turns without end/,
  ],
  [
    'angles that hold times and angles',
    'motion',
    inNode('AnimationCurve', ([keyTime, ...others]) => [
      keyTime!,
      fbxNode('KeyValueFloat', [times], [keyTime!, ...others]),
    ]),
    /turns without end/,
  ],
  [
    'angles of any size',
    'motion',
    keys(
      (i) => i,
      (i) => (i % 2) * 1e30,
    ),
    /turns without end/,
  ],
  [
    'angles that are not finite',
    'motion',
    keys(
      (i) => i,
      () => Number.NaN,
    ),
    /KeyValueFloat in AnimationCurve is damaged/,
  ],
  ['more angles than times', 'motion', withList('AnimationCurve', 'KeyValueFloat', [1, 2, 3]), /3 values for 40 times/],
  [
    'times that do not rise',
    'motion',
    keys(
      (i) => -i,
      (i) => i,
    ),
    /times do not rise/,
  ],
  [
    'more places than can be sorted',
    'motion',
    keys(
      (i) => i,
      (i) => i % 3,
      100_000,
    ),
    /takes minutes/,
  ],
  [
    'a polygon without end',
    'body',
    withList(
      'Geometry',
      'PolygonVertexIndex',
      list((i) => i % 8),
    ),
    /polygon of more than 1000 corners/,
  ],
  [
    'large polygons',
    'body',
    withList(
      'Geometry',
      'PolygonVertexIndex',
      list((i) => (i % 999 === 998 ? -1 : i % 8), 3e6),
    ),
    /takes minutes/,
  ],
  [
    'a polygon of missing vertices',
    'body',
    withList('Geometry', 'PolygonVertexIndex', Int32Array.of(0, 1, -1e9)),
    /vertices are not there/,
  ],
  [
    'bones that weigh one vertex',
    'body',
    changed(
      withList(
        'Geometry',
        'PolygonVertexIndex',
        list((i) => (i % 3 === 2 ? -1 : 0), 300_000),
      ),
      (node) =>
        node.name === 'Deformer' && node.properties[2] === 'Cluster'
          ? {
              ...node,
              children: [
                ...node.children.filter((child) => !['Indexes', 'Weights'].includes(child.name)),
                fbxNode('Indexes', [list(() => 0)]),
                fbxNode('Weights', [Float32Array.from(list(() => 1))]),
              ],
            }
          : node,
    ),
    /takes minutes/,
  ],
  ['more vertices than weights', 'body', withList('Deformer', 'Weights', [1]), /more vertices than weights/],
  ['more nodes than a body', 'body', withObjects(models(5001), []), /more than 5000 nodes/],
  [
    'bones that hold each other',
    'body',
    withObjects(models(2), [connection(50_000, 50_001), connection(50_001, 50_000)]),
    /nested deeper than 256 levels/,
  ],
  [
    'bones one in another',
    'motion',
    withObjects(
      models(1000),
      ids(50_000, 999).map(({ long: id }) => connection(id + 1, id)),
    ),
    /nested deeper than 256 levels/,
  ],
  [
    'skins that share all bones',
    'motion',
    withObjects(
      ids(60_000, 46_000).map((id) =>
        fbxNode('Deformer', [id, 'SubDeformer::', 'Cluster'], [fbxNode('TransformLink', [new Array(16).fill(1)])]),
      ),
      ids(60_000, 46_000).flatMap(({ long: id }) => [connection(id, skin), connection(bone, id)]),
    ),
    /takes minutes/,
  ],
  [
    'one mesh for many nodes',
    'body',
    withObjects(
      models(4000).map((node) => ({ ...node, properties: [node.properties[0]!, 'Model::a', 'Mesh'] })),
      ids(50_000, 4000).map(({ long: id }) => connection(geometry, id)),
    ),
    /million numbers/,
  ],
];

describe.each(fbxForms)('work without end in FBX as %s is refused within a second', (_, write) => {
  test.each(cases)('%s', async (_, parts, nodes, reason) => {
    vi.spyOn(console, 'warn').mockReturnValue(undefined);
    onTestFinished(() => void vi.restoreAllMocks());
    const file = write(nodes);
    const { rss } = process.memoryUsage();
    const started = process.cpuUsage();
    const read = await convertToGlb(file, name, parts).catch((error: unknown) => error);
    const { user, system } = process.cpuUsage(started);
    expect((user + system) / 1000).toBeLessThan(1000);
    expect(process.memoryUsage().rss - rss).toBeLessThan(500e6);
    expect(read).toBeInstanceOf(Error);
    expect((read as Error).message).toMatch(/^person\.fbx: cannot be read as FBX \(.+\)$/s);
    expect((read as Error).message).toMatch(reason);
  });
});
