import { Matrix4, Quaternion, Vector3 } from 'three';
import type { BoneName } from '../../../src/threepoint/core/humanoid/bones';
import { glbOf, padded } from './glb';

type Point = readonly [number, number, number];

/**
 * Joints of a slight woman of 1.62 m in T-pose, facing +Z [m]: narrow shoulders and a short neck, as avatars have them.
 */
const centre: Readonly<Record<string, readonly [parent: string | null, at: Point]>> = {
  hips: [null, [0, 0.92, 0.01]],
  spine: ['hips', [0, 1.0, 0.01]],
  chest: ['spine', [0, 1.11, 0]],
  upperChest: ['chest', [0, 1.22, -0.01]],
  neck: ['upperChest', [0, 1.34, -0.02]],
  head: ['neck', [0, 1.42, 0]],
};
const left: Readonly<Record<string, readonly [parent: string, at: Point]>> = {
  Shoulder: ['upperChest', [0.03, 1.31, -0.02]],
  UpperArm: ['Shoulder', [0.13, 1.3, -0.02]],
  LowerArm: ['UpperArm', [0.36, 1.3, -0.02]],
  Hand: ['LowerArm', [0.58, 1.3, -0.02]],
  ThumbMetacarpal: ['Hand', [0.6, 1.29, 0.01]],
  ThumbProximal: ['ThumbMetacarpal', [0.62, 1.28, 0.03]],
  ThumbDistal: ['ThumbProximal', [0.64, 1.28, 0.04]],
  IndexProximal: ['Hand', [0.66, 1.3, 0]],
  IndexIntermediate: ['IndexProximal', [0.69, 1.3, 0]],
  IndexDistal: ['IndexIntermediate', [0.71, 1.3, 0]],
  MiddleProximal: ['Hand', [0.665, 1.3, -0.02]],
  LittleProximal: ['Hand', [0.65, 1.3, -0.055]],
  LittleIntermediate: ['LittleProximal', [0.67, 1.3, -0.055]],
  LittleDistal: ['LittleIntermediate', [0.685, 1.3, -0.055]],
  UpperLeg: ['hips', [0.08, 0.86, 0.01]],
  LowerLeg: ['UpperLeg', [0.08, 0.47, 0.015]],
  Foot: ['LowerLeg', [0.08, 0.08, -0.02]],
  Toes: ['Foot', [0.08, 0.01, 0.1]],
};

export interface Joint {
  readonly bone: BoneName;
  readonly parent: BoneName | null;
  readonly at: Vector3;
}

/** A joint that bodies have no name for; its parent null: it hangs from the armature. */
export interface MoreJoint {
  readonly called: string;
  readonly parent: BoneName | null;
  readonly at: Point;
}

export function rigJoints({
  without = [],
  parents = {},
  more = [],
  place,
}: Pick<RigOptions, 'without' | 'parents' | 'more' | 'place'>): Joint[] {
  const all = new Map<string, Joint>();
  const put = (bone: string, parent: string | null, [x, y, z]: Point) =>
    all.set(bone, { bone: bone as BoneName, parent: parent as BoneName | null, at: new Vector3(x, y, z) });
  for (const [bone, [parent, at]] of Object.entries(centre)) put(bone, parent, at);
  for (const side of ['left', 'right']) {
    for (const [bone, [parent, [x, y, z]]] of Object.entries(left)) {
      put(`${side}${bone}`, parent in centre ? parent : `${side}${parent}`, [side === 'left' ? x : -x, y, z]);
    }
  }
  const kept = (bone: string | null): string | null =>
    bone !== null && without.includes(bone) ? kept(all.get(bone)?.parent ?? null) : bone;
  const named = [...all.values()]
    .filter(({ bone }) => !without.includes(bone))
    .map(({ bone, parent, at }) => ({
      ...{ bone, at },
      parent: bone in parents ? ((parents[bone] ?? null) as BoneName | null) : (kept(parent) as BoneName | null),
    }));
  for (const { bone, at } of named) place?.(bone, at);
  return [
    ...named,
    ...more.map(({ called, parent, at }) => ({ bone: called as BoneName, parent, at: new Vector3(...at) })),
  ];
}

/** The bones of a right arm. */
export const rightArm: readonly string[] = Object.keys(left)
  .filter((bone) => /Arm|Hand|Thumb|Index|Middle|Little|Shoulder/.test(bone))
  .map((bone) => `right${bone}`);

export interface RigOptions {
  /** What the file calls a bone. */
  readonly nameOf: (bone: BoneName) => string;
  readonly without?: readonly string[];
  /** The bone or further joint from which a bone hangs instead of its usual parent; null: the armature. */
  readonly parents?: Readonly<Partial<Record<BoneName, string | null>>> | undefined;
  /** Joints with skin beside those that bodies have names for. */
  readonly more?: readonly MoreJoint[] | undefined;
  /** Moves joints: other proportions. */
  readonly place?: ((bone: BoneName, at: Vector3) => void) | undefined;
  /** Each joint carries a box that is no skin, and there is no skin. */
  readonly rigid?: boolean;
  /** Boxes that are no skin and hang from the armature, by the name of their node. */
  readonly beside?: Readonly<Record<string, Point>> | undefined;
  /** Arms hang this far down and forearms are bent ahead [degrees]. */
  readonly armsDown?: number;
  /** Above the bones: what an exporter puts there. */
  readonly root?: Matrix4;
  /** The scale of the root; with 0 its matrix has no rotation. */
  readonly rootScale?: number;
  /** Lengths of the bones and of the skin in the file [per metre]. */
  readonly unit?: number;
  /** Bones that bodies have no name for. */
  readonly moreBones?: number;
  readonly interleaved?: boolean;
  /** The nodes stand in another pose than the one the skin was bound in: arms up, moved away. */
  readonly posed?: boolean;
}

/** Returns the bones in the file's pose. */
function pose(all: readonly Joint[], armsDown: number): Map<BoneName, Matrix4> {
  const worlds = new Map<BoneName, Matrix4>();
  for (const { bone, at } of all) worlds.set(bone, new Matrix4().setPosition(at));
  const turn = (from: string, axis: Vector3, degrees: number) => {
    const pivot = new Vector3().setFromMatrixPosition(worlds.get(from as BoneName)!);
    const move = new Matrix4()
      .makeTranslation(pivot)
      .multiply(new Matrix4().makeRotationAxis(axis, (degrees * Math.PI) / 180))
      .multiply(new Matrix4().makeTranslation(pivot.clone().negate()));
    const below = (joint: Joint | undefined): boolean =>
      joint !== undefined && (joint.bone === from || below(all.find(({ bone }) => bone === joint.parent)));
    for (const joint of all) if (below(joint)) worlds.get(joint.bone)!.premultiply(move);
  };
  for (const [side, sign] of [
    ['left', -1],
    ['right', 1],
  ] as const) {
    if (armsDown === 0) continue;
    turn(`${side}LowerArm`, new Vector3(0, 1, 0), sign * 15);
    turn(`${side}UpperArm`, new Vector3(0, 0, 1), sign * armsDown);
  }
  return worlds;
}

export const boxCorners = [0, 1, 2, 3, 4, 5, 6, 7].map(
  (i) => new Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1),
);
export const boxFaces = [
  0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5,
];
/** Half the side of the box about each joint [m]. */
export const boxHalf = 0.02;

/** Vertex data: each attribute in a row of its own, or all of a vertex together. */
function vertexData(count: number, positions: Float32Array, interleaved: boolean) {
  const boxes = count / 8;
  const jointOf = (vertex: number) => Math.floor(vertex / 8);
  if (!interleaved) {
    const bones = new Uint16Array(count * 4);
    const weights = new Float32Array(count * 4);
    for (let vertex = 0; vertex < count; vertex++) {
      bones[vertex * 4] = jointOf(vertex);
      weights[vertex * 4] = 1;
    }
    return { boxes, buffers: [positions, bones, weights].map((array) => new Uint8Array(array.buffer)), stride: 0 };
  }
  const stride = 36;
  const buffer = new DataView(new ArrayBuffer(count * stride));
  for (let vertex = 0; vertex < count; vertex++) {
    for (let i = 0; i < 3; i++) buffer.setFloat32(vertex * stride + i * 4, positions[vertex * 3 + i] as number, true);
    buffer.setUint16(vertex * stride + 12, jointOf(vertex), true);
    buffer.setFloat32(vertex * stride + 20, 1, true);
  }
  return { boxes, buffers: [new Uint8Array(buffer.buffer)], stride };
}

/**
 * A humanoid GLB made from nothing: a box of skin about each joint, bound to that joint alone, in the order of its
 * bones.
 */
export function builtRig(options: RigOptions): ArrayBuffer {
  const { nameOf, more: further = [], armsDown = 0, root = new Matrix4(), rootScale, unit = 1 } = options;
  const all = rigJoints(options);
  const called = new Set(further.map((joint) => joint.called));
  const bound = pose(all, armsDown);
  const scaled = (matrix: Matrix4) =>
    matrix.clone().setPosition(new Vector3().setFromMatrixPosition(matrix).multiplyScalar(unit));
  const shown = options.posed ? posedOf(all, bound) : bound;
  const nodes: Record<string, unknown>[] = [
    {
      name: 'Armature',
      children: [],
      ...(rootScale === undefined ? { matrix: root.toArray() } : { scale: [rootScale, rootScale, rootScale] }),
    },
  ];
  const children = new Map<BoneName | null, number[]>();
  for (const [index, { bone, parent }] of all.entries()) {
    children.set(parent, [...(children.get(parent) ?? []), index + 1]);
    const own = scaled(shown.get(bone)!);
    const above = parent ? scaled(shown.get(parent)!) : new Matrix4();
    const [position, turn] = [new Vector3(), new Quaternion()];
    above.invert().multiply(own).decompose(position, turn, new Vector3());
    nodes.push({
      name: called.has(bone) ? bone : nameOf(bone),
      ...{ translation: position.toArray(), rotation: turn.toArray() },
      ...(options.rigid && { mesh: 0 }),
    });
  }
  nodes[0]!.children = children.get(null);
  for (const [index, { bone }] of all.entries()) {
    const below = children.get(bone);
    if (below) nodes[index + 1]!.children = below;
  }
  const more = Array.from({ length: options.moreBones ?? 0 }, (_, i) => nodes.push({ name: `cloth_${i}` }) - 1);
  if (more.length > 0) nodes[1]!.children = [...(nodes[1]!.children as number[]), ...more];
  const atTop = nodes[0]!.children as number[];
  if (!options.rigid) atTop.push(nodes.push({ name: 'Body', mesh: 0, skin: 0 }) - 1);
  for (const [name, at] of Object.entries(options.beside ?? {})) {
    const translation = at.map((value) => value * unit);
    atTop.push(nodes.push({ name, translation, mesh: options.rigid ? 0 : 1 }) - 1);
  }

  const positions = new Float32Array(all.length * 24);
  const inverses = new Float32Array((all.length + more.length) * 16);
  for (const [index, { bone }] of all.entries()) {
    const matrix = bound.get(bone)!;
    for (const [corner, offset] of boxCorners.entries()) {
      const vertex = offset.clone().multiplyScalar(boxHalf).applyMatrix4(matrix).multiplyScalar(unit);
      vertex.toArray(positions, (index * 8 + corner) * 3);
    }
    scaled(matrix)
      .invert()
      .toArray(inverses, index * 16);
  }
  for (const [i] of more.entries()) {
    scaled(bound.get('hips')!)
      .invert()
      .toArray(inverses, (all.length + i) * 16);
  }
  const indices = new Uint16Array(all.flatMap((_, box) => boxFaces.map((corner) => box * 8 + corner)));
  const box = Float32Array.from(
    boxCorners.flatMap((corner) => corner.toArray()),
    (value) => value * boxHalf * unit,
  );
  const { buffers, stride } = vertexData(all.length * 8, positions, options.interleaved ?? false);
  const skinned = [...buffers, ...[box, indices, inverses].map(({ buffer }) => new Uint8Array(buffer))];
  return glb(nodes, skinned, {
    joints: [...all.map((_, i) => i + 1), ...more],
    vertices: all.length * 8,
    indices: indices.length,
    stride,
    rigid: options.rigid ?? false,
    boxes: options.beside !== undefined,
  });
}

/** An arm raised, the whole a stride ahead: a picture of an animation. */
function posedOf(all: readonly Joint[], bound: Map<BoneName, Matrix4>): Map<BoneName, Matrix4> {
  const raised = pose(all, 0);
  const move = new Matrix4().makeTranslation(2, 0, 1);
  const half = new Matrix4().makeRotationZ(0.7);
  for (const { bone } of all) {
    const matrix = raised.get(bone) ?? bound.get(bone)!;
    if (/^left(UpperArm|LowerArm|Hand|Index|Middle|Little|Thumb)/.test(bone)) {
      const pivot = all.find((joint) => joint.bone === 'leftUpperArm')!.at;
      matrix
        .premultiply(new Matrix4().makeTranslation(pivot.clone().negate()))
        .premultiply(half)
        .premultiply(new Matrix4().makeTranslation(pivot));
    }
    matrix.premultiply(move);
  }
  return raised;
}

interface Counts {
  readonly joints: readonly number[];
  readonly vertices: number;
  readonly indices: number;
  readonly stride: number;
  /** There are boxes and no skin. */
  readonly rigid: boolean;
  /** There are boxes. */
  readonly boxes: boolean;
}

function glb(nodes: unknown, parts: readonly Uint8Array[], counts: Counts): ArrayBuffer {
  const { joints, vertices, indices, stride, rigid, boxes } = counts;
  const views: object[] = [];
  let length = 0;
  for (const part of parts) {
    views.push({ buffer: 0, byteOffset: length, byteLength: part.length });
    length += padded(part.length);
  }
  if (stride > 0) views[0] = { ...views[0], byteStride: stride };
  const [float, short] = [5126, 5123];
  const bounds = { min: [-500, -500, -500], max: [500, 500, 500] };
  const of = (view: number, componentType: number, type: string, count: number, more: object = {}) => ({
    ...{ bufferView: view, componentType, type, count },
    ...more,
  });
  const interleaved = stride > 0;
  const accessors = [
    of(0, float, 'VEC3', vertices, bounds),
    of(interleaved ? 0 : 1, short, 'VEC4', vertices, interleaved ? { byteOffset: 12 } : {}),
    of(interleaved ? 0 : 2, float, 'VEC4', vertices, interleaved ? { byteOffset: 20 } : {}),
    of(views.length - 2, short, 'SCALAR', indices),
    of(views.length - 1, float, 'MAT4', joints.length),
    of(views.length - 3, float, 'VEC3', 8, bounds),
    of(views.length - 2, short, 'SCALAR', boxFaces.length),
  ];
  const skin = { primitives: [{ attributes: { POSITION: 0, JOINTS_0: 1, WEIGHTS_0: 2 }, indices: 3 }] };
  const box = { primitives: [{ attributes: { POSITION: 5 }, indices: 6 }] };
  const binary = new Uint8Array(length);
  let at = 0;
  for (const part of parts) {
    binary.set(part, at);
    at += padded(part.length);
  }
  const json = {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes,
    meshes: [...(rigid ? [] : [skin]), ...(rigid || boxes ? [box] : [])],
    ...(!rigid && { skins: [{ joints, inverseBindMatrices: 4 }] }),
    accessors,
    bufferViews: views,
    buffers: [{ byteLength: length }],
  };
  return glbOf(json, binary);
}
