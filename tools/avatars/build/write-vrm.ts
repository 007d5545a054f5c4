import { type Accessor, Document, type Material, NodeIO } from '@gltf-transform/core';
import { type FaceShape, type Figure, type Label, labels, type MaterialName, type MeshPlan, tintOf } from './figure';
import type { BodyRig } from './rig';
import type { Point } from './signed-distance';
import type { Surface } from './surface';
import type { SkinWeights } from './weights';

/** A body's skin, cut and weighed. */
export interface Skinned {
  readonly surface: Surface;
  readonly normals: Float32Array;
  readonly skin: SkinWeights;
  /** The label of each triangle, and whether it belongs to the head. */
  readonly labels: readonly Label[];
  readonly ofHead: readonly boolean[];
  /** The share of the light that reaches each vertex; null: all of it. */
  readonly light: Float32Array | null;
  /** How far each vertex goes for each shape of the face [m]. */
  readonly shapes: readonly { readonly name: FaceShape; readonly moves: Float32Array }[];
}

/** A body as VRM 1.0 wants it: fingers, toes and all. */
export async function writeVrm(figure: Figure, skinned: Skinned): Promise<Uint8Array> {
  const { bones } = figure.rig;
  const document = new Document();
  const buffer = document.createBuffer();
  const scene = document.createScene(figure.name);
  const nodes = new Map(bones.map((bone) => [bone.name, document.createNode(bone.name)]));
  const jointOf = new Map(bones.map((bone) => [bone.name, bone.joint]));
  for (const { name, parent, joint } of bones) {
    const node = nodes.get(name)!;
    const origin = parent ? jointOf.get(parent)! : [0, 0, 0];
    node.setTranslation([joint[0] - origin[0]!, joint[1] - origin[1]!, joint[2] - origin[2]!]);
    if (parent) nodes.get(parent)!.addChild(node);
    else scene.addChild(node);
  }
  const inverseBinds = new Float32Array(bones.length * 16);
  bones.forEach(({ joint: [x, y, z] }, index) => {
    inverseBinds.set([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1], index * 16);
  });
  const skeleton = document
    .createSkin('skeleton')
    .setSkeleton(nodes.get('hips')!)
    .setInverseBindMatrices(document.createAccessor().setType('MAT4').setArray(inverseBinds).setBuffer(buffer));
  for (const { name } of bones) skeleton.addJoint(nodes.get(name)!);
  const accessor = (type: 'VEC3' | 'VEC4' | 'SCALAR', array: Float32Array | Uint8Array | Uint16Array): Accessor =>
    document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  // Meshes share materials; one that no triangle has is not created.
  const materials = new Map<MaterialName, Material>();
  const shaped = new Map<string, readonly FaceShape[]>();
  for (const plan of figure.meshes) {
    const mesh = document.createMesh(plan.name);
    const parts = plan.materials
      .map((name) => ({ name, own: ownVertices(figure, skinned, name, plan) }))
      .filter(({ own }) => own.indices.length > 0);
    const shapes = skinned.shapes.filter(({ moves }) => parts.some(({ own }) => movesAny(own.vertices, moves)));
    for (const { name, own } of parts) {
      const material = materials.get(name) ?? createMaterial(document, figure, name);
      materials.set(name, material);
      const primitive = document.createPrimitive().setMaterial(material);
      const pick = (size: number, from: ArrayLike<number>): number[] =>
        own.vertices.flatMap((vertex) => Array.from({ length: size }, (_, i) => from[vertex * size + i]!));
      primitive
        .setAttribute('POSITION', accessor('VEC3', new Float32Array(pick(3, skinned.surface.positions))))
        .setAttribute('NORMAL', accessor('VEC3', new Float32Array(pick(3, skinned.normals))))
        .setAttribute('JOINTS_0', accessor('VEC4', new Uint8Array(pick(4, skinned.skin.joints))))
        .setAttribute(
          'WEIGHTS_0',
          accessor('VEC4', bytesOf(new Float32Array(pick(4, skinned.skin.weights)))).setNormalized(true),
        )
        .setIndices(accessor('SCALAR', Uint16Array.from(own.indices)));
      if (own.tints) {
        primitive.setAttribute('COLOR_0', accessor('VEC4', Uint8Array.from(own.tints)).setNormalized(true));
      }
      for (const { name: shape, moves } of shapes) {
        const moved = accessor('VEC3', new Float32Array(pick(3, moves))).setSparse(true);
        primitive.addTarget(document.createPrimitiveTarget(shape).setAttribute('POSITION', moved));
      }
      mesh.addPrimitive(primitive);
    }
    const targetNames = shapes.map(({ name }) => name);
    if (targetNames.length > 0) mesh.setWeights(targetNames.map(() => 0)).setExtras({ targetNames });
    shaped.set(plan.name, targetNames);
    scene.addChild(document.createNode(plan.name).setMesh(mesh).setSkin(skeleton));
  }
  return withVrm(await new NodeIO().writeBinary(document), figure, shaped);
}

/** Whether a shape moves one of these vertices. */
const movesAny = (vertices: readonly number[], moves: Float32Array): boolean =>
  vertices.some((vertex) => moves[3 * vertex] || moves[3 * vertex + 1] || moves[3 * vertex + 2]);

/** The colour of a vertex as bytes. */
function bytesAt({ tint }: Figure, { surface, light }: Skinned, label: Label, vertex: number): number[] {
  const [x, y, z] = surface.positions.subarray(3 * vertex, 3 * vertex + 3) as unknown as Point;
  const own = tint?.(label, x, y, z) ?? [1, 1, 1];
  return tintOf(label).map((share, channel) => Math.round(255 * share * own[channel]! * (light?.[vertex] ?? 1)));
}

/** A vertex is there once for each label it has triangles of. */
interface OwnVertices {
  /** By their number on the surface. */
  readonly vertices: readonly number[];
  readonly indices: readonly number[];
  /** Bytes, four a vertex; null: all are white. */
  readonly tints: readonly number[] | null;
}

/**
 * The vertices of one material in one mesh. A primitive has its own: a shared buffer would be skinned once for every
 * primitive.
 */
function ownVertices(figure: Figure, skinned: Skinned, name: MaterialName, { ofHead }: MeshPlan): OwnVertices {
  const index = new Map<string, number>();
  const vertices: number[] = [];
  const tints: number[] = [];
  const indices: number[] = [];
  skinned.labels.forEach((label, t) => {
    if (labels[label].material !== name || skinned.ofHead[t] !== ofHead) return;
    for (let corner = 0; corner < 3; corner++) {
      const vertex = skinned.surface.indices[3 * t + corner]!;
      const key = `${vertex} ${label}`;
      let own = index.get(key);
      if (own === undefined) {
        own = vertices.push(vertex) - 1;
        tints.push(...bytesAt(figure, skinned, label, vertex), 255);
        index.set(key, own);
      }
      indices.push(own);
    }
  });
  return { vertices, indices, tints: tints.every((byte) => byte === 255) ? null : tints };
}

function createMaterial(document: Document, { colors }: Figure, name: MaterialName): Material {
  const look = colors[name];
  if (!look) throw new Error(`build-avatar: no colour for ${name}`);
  const { color, roughness, metallic = 0 } = look;
  return document
    .createMaterial(name)
    .setBaseColorFactor([...color, 1])
    .setRoughnessFactor(roughness)
    .setMetallicFactor(metallic);
}

/** Weights as bytes whose four sum to 255 exactly. */
function bytesOf(weights: Float32Array): Uint8Array {
  const bytes = new Uint8Array(weights.length);
  for (let v = 0; v < weights.length; v += 4) {
    let left = 255;
    for (let slot = 3; slot > 0; slot--) {
      bytes[v + slot] = Math.round(weights[v + slot]! * 255);
      left -= bytes[v + slot]!;
    }
    bytes[v] = left;
  }
  return bytes;
}

/** Eyes that turn on their bones as far as a target is aside, up to an angle at which pupils are still seen whole. */
function lookAtOf({ bones }: BodyRig) {
  const [head, eye] = ['head', 'leftEye'].map((bone) => bones.find(({ name }) => name === bone)!.joint);
  const range = (degrees: number) => ({ inputMaxValue: degrees, outputScale: degrees });
  return {
    type: 'bone',
    offsetFromHeadBone: [0, eye![1] - head![1], eye![2] - head![2]],
    rangeMapHorizontalInner: range(24),
    rangeMapHorizontalOuter: range(24),
    rangeMapVerticalDown: range(14),
    rangeMapVerticalUp: range(14),
  };
}

interface GltfJson {
  nodes: { name: string }[];
  extensionsUsed?: string[];
  extensions?: Record<string, unknown>;
  asset: { generator?: string };
}

/**
 * Puts the VRM 1.0 extension into a GLB: which node is which bone, what is hidden in first person, the shapes of the
 * face, the licence. `shaped`: by mesh, the shapes that it has, in their order.
 */
function withVrm(
  glb: Uint8Array,
  { name, rig, meshes, shapes, pieces }: Figure,
  shaped: ReadonlyMap<string, readonly FaceShape[]>,
): Uint8Array {
  const view = new DataView(glb.buffer, glb.byteOffset, glb.byteLength);
  const jsonLength = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(glb.subarray(20, 20 + jsonLength))) as GltfJson;
  const node = (name: string): number => json.nodes.findIndex((candidate) => candidate.name === name);
  const binds = (shape: FaceShape) =>
    [...shaped].flatMap(([mesh, targets]) =>
      targets.includes(shape) ? [{ node: node(mesh), index: targets.indexOf(shape), weight: 1 }] : [],
    );
  const preset = Object.keys(shapes).map((shape) => [shape, { morphTargetBinds: binds(shape as FaceShape) }]);
  json.asset.generator = 'threepoint build-avatar';
  json.extensionsUsed = [...(json.extensionsUsed ?? []), 'VRMC_vrm'];
  json.extensions = {
    ...json.extensions,
    VRMC_vrm: {
      specVersion: '1.0',
      meta: {
        name: `threepoint ${name}`,
        version: '1',
        authors: ['threepoint'],
        licenseUrl: 'https://vrm.dev/licenses/1.0/',
        avatarPermission: 'everyone',
        allowExcessivelyViolentUsage: true,
        allowExcessivelySexualUsage: true,
        commercialUsage: 'corporation',
        allowPoliticalOrReligiousUsage: true,
        allowAntisocialOrHateUsage: true,
        creditNotation: 'unnecessary',
        allowRedistribution: true,
        modification: 'allowModificationRedistribution',
      },
      humanoid: { humanBones: Object.fromEntries(rig.bones.map(({ name }) => [name, { node: node(name) }])) },
      firstPerson: {
        meshAnnotations: meshes.map(({ name, ofHead }) => ({
          node: node(name),
          type: ofHead ? 'thirdPersonOnly' : 'both',
        })),
      },
      ...(pieces && { lookAt: lookAtOf(rig) }),
      ...(preset.length > 0 && { expressions: { preset: Object.fromEntries(preset) } }),
    },
  };
  const text = new TextEncoder().encode(JSON.stringify(json));
  const padded = new Uint8Array(Math.ceil(text.length / 4) * 4).fill(0x20);
  padded.set(text);
  const rest = glb.subarray(20 + jsonLength);
  const result = new Uint8Array(20 + padded.length + rest.length);
  result.set(glb.subarray(0, 20));
  result.set(padded, 20);
  result.set(rest, 20 + padded.length);
  const header = new DataView(result.buffer);
  header.setUint32(8, result.length, true);
  header.setUint32(12, padded.length, true);
  return result;
}
