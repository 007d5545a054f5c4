import { type Accessor, Document, type Material, NodeIO } from '@gltf-transform/core';
import { bones } from './rig';
import type { Surface } from './surface';
import type { SkinWeights } from './weights';

/** Materials by name: the page recolours them, one palette per player. */
export type MaterialName = 'Suit' | 'Accent' | 'Head' | 'Visor';

const look: Readonly<Record<MaterialName, { color: [number, number, number]; roughness: number; metallic: number }>> = {
  Suit: { color: [0.62, 0.66, 0.72], roughness: 0.62, metallic: 0 },
  Accent: { color: [0.075, 0.24, 0.5], roughness: 0.5, metallic: 0.05 },
  Head: { color: [0.84, 0.82, 0.79], roughness: 0.55, metallic: 0 },
  Visor: { color: [0.03, 0.035, 0.045], roughness: 0.16, metallic: 0.4 },
};

/** Only seen by others: the own head would be seen from inside. */
const headMaterials: readonly MaterialName[] = ['Head', 'Visor'];

/** Fingers, toes and all as VRM 1.0 wants them. */
export async function writeVrm(
  surface: Surface,
  normals: Float32Array,
  skin: SkinWeights,
  materials: readonly MaterialName[],
): Promise<Uint8Array> {
  const document = new Document();
  const buffer = document.createBuffer();
  const scene = document.createScene('mannequin');
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

  const accessor = (
    type: 'VEC3' | 'VEC4' | 'SCALAR',
    array: Float32Array | Uint8Array | Uint16Array,
    normalized = false,
  ): Accessor => document.createAccessor().setType(type).setArray(array).setNormalized(normalized).setBuffer(buffer);
  const attributes = {
    POSITION: accessor('VEC3', surface.positions),
    NORMAL: accessor('VEC3', normals),
    JOINTS_0: accessor('VEC4', skin.joints),
    WEIGHTS_0: accessor('VEC4', eighths(skin.weights), true),
  };
  const parts = [
    { name: 'bodySkin', materials: ['Suit', 'Accent'] as MaterialName[] },
    { name: 'headSkin', materials: [...headMaterials] },
  ];
  for (const part of parts) {
    const mesh = document.createMesh(part.name);
    for (const name of part.materials) {
      const indices: number[] = [];
      materials.forEach((material, t) => {
        if (material === name) indices.push(...surface.indices.subarray(3 * t, 3 * t + 3));
      });
      // A primitive of its own vertices: a shared buffer would be skinned once for every primitive.
      const renumbered = [...new Set(indices)];
      const index = new Map(renumbered.map((vertex, i) => [vertex, i]));
      const primitive = document.createPrimitive().setMaterial(material(document, name));
      for (const [semantic, whole] of Object.entries(attributes)) {
        const size = whole.getElementSize();
        const array = whole.getArray()!;
        const own = new (array.constructor as Float32ArrayConstructor)(renumbered.length * size);
        for (const [i, vertex] of renumbered.entries()) {
          own.set(array.subarray(vertex * size, (vertex + 1) * size) as Float32Array, i * size);
        }
        primitive.setAttribute(semantic, accessor(whole.getType() as 'VEC3', own, whole.getNormalized()));
      }
      primitive.setIndices(
        accessor(
          'SCALAR',
          Uint16Array.from(indices, (vertex) => index.get(vertex)!),
        ),
      );
      mesh.addPrimitive(primitive);
    }
    scene.addChild(document.createNode(part.name).setMesh(mesh).setSkin(skeleton));
  }
  for (const whole of Object.values(attributes)) whole.dispose();
  return withVrm(await new NodeIO().writeBinary(document));
}

const made = new WeakMap<Document, Map<MaterialName, Material>>();

function material(document: Document, name: MaterialName): Material {
  const known = made.get(document) ?? new Map<MaterialName, Material>();
  made.set(document, known);
  const { color, roughness, metallic } = look[name];
  const material =
    known.get(name) ??
    document
      .createMaterial(name)
      .setBaseColorFactor([...color, 1])
      .setRoughnessFactor(roughness)
      .setMetallicFactor(metallic);
  known.set(name, material);
  return material;
}

/** Weights as bytes whose four sum to 255 exactly. */
function eighths(weights: Float32Array): Uint8Array {
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

interface GltfJson {
  nodes: { name: string }[];
  extensionsUsed?: string[];
  extensions?: Record<string, unknown>;
  asset: { generator?: string };
}

/** Puts the VRM 1.0 extension into a GLB: which node is which bone, what is hidden in first person, the licence. */
function withVrm(glb: Uint8Array): Uint8Array {
  const view = new DataView(glb.buffer, glb.byteOffset, glb.byteLength);
  const jsonLength = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(glb.subarray(20, 20 + jsonLength))) as GltfJson;
  const node = (name: string): number => json.nodes.findIndex((candidate) => candidate.name === name);
  json.asset.generator = 'threepoint build-avatar';
  json.extensionsUsed = [...(json.extensionsUsed ?? []), 'VRMC_vrm'];
  json.extensions = {
    ...json.extensions,
    VRMC_vrm: {
      specVersion: '1.0',
      meta: {
        name: 'threepoint mannequin',
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
      humanoid: { humanBones: Object.fromEntries(bones.map(({ name }) => [name, { node: node(name) }])) },
      firstPerson: {
        meshAnnotations: [
          { node: node('bodySkin'), type: 'both' },
          { node: node('headSkin'), type: 'thirdPersonOnly' },
        ],
      },
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
