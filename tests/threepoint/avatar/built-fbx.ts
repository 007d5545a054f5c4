import { Matrix4, Vector3 } from 'three';
import type { BoneName } from '../../../src/threepoint/core/humanoid/bones';
import { boxCorners, boxFaces, boxHalf, type RigOptions, rigJoints } from './built-rig';
import { type FbxNode, long, fbxNode as node } from './fbx-file';

/** FBX counts time in these [1/s]. */
const ticks = 46_186_158_000;
/** Lengths in the file [per metre]. */
const unit = 100;

/** The angles about x, y and z [degrees] of a bone in each frame. */
export type BoneTurns = Readonly<Partial<Record<BoneName, readonly (readonly [number, number, number])[]>>>;

/** A clip of two arms. */
export const wave = {
  leftUpperArm: Array.from({ length: 40 }, (_, frame) => [0, 0, -frame] as const),
  rightLowerArm: Array.from({ length: 40 }, (_, frame) => [0, 4 * frame, 0] as const),
};

export interface BuiltFbxOptions extends Pick<RigOptions, 'nameOf' | 'without' | 'more' | 'place'> {
  /** The clip; absent: there is none. */
  readonly turns?: BoneTurns;
  /** The places of the hips in each frame of the clip [m]. */
  readonly hips?: readonly (readonly [number, number, number])[];
  readonly rateHz?: number;
  /** There are bones and no skin. */
  readonly bare?: boolean;
  /** A picture on the skin, as binary files contain it. */
  readonly picture?: Uint8Array;
  /** A camera and a light, as editors leave them in their files. */
  readonly studio?: boolean;
}

const property = (name: string, type: string, ...values: readonly (number | ReturnType<typeof long>)[]): FbxNode =>
  node('P', [name, type, '', 'A', ...values]);
const properties = (...list: readonly FbxNode[]): FbxNode => node('Properties70', [], list);

/** The nodes of an FBX file with a humanoid in T-pose: a box of skin about each joint, and a clip of its bones. */
export function builtFbx(options: BuiltFbxOptions): readonly FbxNode[] {
  const { nameOf, more = [], turns = {}, hips = [], rateHz = 30, bare = false, picture, studio = false } = options;
  const joints = rigJoints(options);
  const called = new Set(more.map((joint) => joint.called));
  const objects: FbxNode[] = [];
  const connections: FbxNode[] = [];
  let count = 1000;
  const object = (kind: string, label: string, type: string, children: readonly FbxNode[] = []): number => {
    count += 1;
    objects.push(node(kind, [long(count), label, type], children));
    return count;
  };
  const connect = (from: number, to: number, as?: string) =>
    connections.push(node('C', [as ? 'OP' : 'OO', long(from), long(to), ...(as ? [as] : [])]));

  const bones = new Map<BoneName, number>();
  for (const { bone, parent, at } of joints) {
    const from = joints.find((joint) => joint.bone === parent)?.at ?? new Vector3();
    const place = at.clone().sub(from).multiplyScalar(unit).toArray();
    const name = called.has(bone) ? bone : nameOf(bone);
    const settings = properties(property('Lcl Translation', 'Lcl Translation', ...place));
    bones.set(bone, object('Model', `Model::${name}`, 'LimbNode', [settings]));
  }
  for (const { bone, parent } of joints) connect(bones.get(bone)!, parent ? bones.get(parent)! : 0);
  if (!bare) addSkin();
  if (studio) {
    for (const kind of ['Camera', 'Light']) {
      connect(object('NodeAttribute', `NodeAttribute::${kind}`, kind, [node('NearPlane', [1])]), addModel(kind));
    }
  }
  addClip();
  return [
    node('FBXHeaderExtension', [], [node('FBXHeaderVersion', [1003]), node('FBXVersion', [7400])]),
    node('GlobalSettings', [], [properties(property('UpAxis', 'int', 1), property('UnitScaleFactor', 'double', 1))]),
    node('Objects', [], objects),
    node('Connections', [], connections),
  ];

  function addModel(kind: string): number {
    const model = object('Model', `Model::${kind}`, kind, [node('Version', [232])]);
    connect(model, 0);
    return model;
  }

  function addSkin(): void {
    const corners = joints.flatMap(({ at }) =>
      boxCorners.flatMap((corner) => corner.clone().multiplyScalar(boxHalf).add(at).multiplyScalar(unit).toArray()),
    );
    const faces = joints.flatMap((_, box) =>
      boxFaces.map((corner, i) => (i % 3 === 2 ? -(box * 8 + corner) - 1 : box * 8 + corner)),
    );
    const geometry = object('Geometry', 'Geometry::Body', 'Mesh', [
      node('Vertices', [corners]),
      node('PolygonVertexIndex', [Int32Array.from(faces)]),
      ...(picture
        ? [
            node(
              'LayerElementUV',
              [0],
              [
                node('MappingInformationType', ['ByVertice']),
                node('ReferenceInformationType', ['Direct']),
                node('UV', [joints.flatMap(() => boxCorners.flatMap(({ x, y }) => [(1 + x) / 2, (1 + y) / 2]))]),
              ],
            ),
          ]
        : []),
    ]);
    const body = object('Model', 'Model::Body', 'Mesh', [node('Version', [232])]);
    const surface = object('Material', 'Material::Skin', '', [
      node('ShadingModel', ['phong']),
      properties(node('P', ['DiffuseColor', 'Color', '', 'A', 0.5, 0.25, 0.125])),
    ]);
    const skin = object('Deformer', 'Deformer::', 'Skin', [node('Version', [101])]);
    connect(body, 0);
    if (picture) {
      const video = object('Video', 'Video::skin.png', 'Clip', [
        node('RelativeFilename', ['skin.png']),
        node('Content', [picture]),
      ]);
      const texture = object('Texture', 'Texture::skin', '', [node('FileName', ['skin.png'])]);
      connect(video, texture);
      connect(texture, surface, 'DiffuseColor');
    }
    for (const [from, to] of [[geometry, body], [surface, body], [skin, geometry]] as const) connect(from, to); // biome-ignore format: pairs
    for (const [index, { bone, at }] of joints.entries()) {
      const link = Array.from(new Matrix4().setPosition(at.clone().multiplyScalar(unit)).elements);
      const own = Array.from({ length: 8 }, (_, corner) => index * 8 + corner);
      const cluster = object('Deformer', 'SubDeformer::', 'Cluster', [
        node('Indexes', [Int32Array.from(own)]),
        node('Weights', [own.map(() => 1)]),
        node('Transform', [Array.from(new Matrix4().elements)]),
        node('TransformLink', [link]),
      ]);
      connect(cluster, skin);
      connect(bones.get(bone)!, cluster);
    }
  }

  function addClip(): void {
    if (Object.keys(turns).length === 0 && hips.length === 0) return;
    const stack = object('AnimationStack', 'AnimStack::clip', '', [node('Description', ['a clip'])]);
    const layer = object('AnimationLayer', 'AnimLayer::BaseLayer', '', [node('Weight', [100])]);
    connect(layer, stack);
    const curves = (bone: BoneName, kind: 'R' | 'T', frames: readonly (readonly [number, number, number])[]) => {
      const curveNode = object('AnimationCurveNode', `AnimCurveNode::${kind}`, '', [node('Version', [1])]);
      connect(curveNode, layer);
      connect(curveNode, bones.get(bone)!, kind === 'R' ? 'Lcl Rotation' : 'Lcl Translation');
      for (const [axis, letter] of ['X', 'Y', 'Z'].entries()) {
        const times = BigInt64Array.from(frames, (_, frame) => BigInt(Math.round((frame * ticks) / rateHz)));
        const curve = object('AnimationCurve', 'AnimCurve::', '', [
          node('KeyTime', [times]),
          node('KeyValueFloat', [Float32Array.from(frames, (frame) => frame[axis]!)]),
        ]);
        connect(curve, curveNode, `d|${letter}`);
      }
    };
    for (const [bone, frames] of Object.entries(turns)) curves(bone as BoneName, 'R', frames);
    if (hips.length > 0)
      curves(
        'hips',
        'T',
        hips.map(([x, y, z]) => [x * unit, y * unit, z * unit] as const),
      );
  }
}
