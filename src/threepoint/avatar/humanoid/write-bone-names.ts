import { type BoneMap, boneNames } from '../../core/humanoid/bones';
import { packGlb } from '../../core/motion/gltf';
import { readGlbChunks } from '../file/glb-chunks';

interface MappedGltf {
  [field: string]: unknown;
  nodes?: { name?: string }[];
  skins?: { joints: number[] }[];
  extensions?: {
    VRMC_vrm?: { humanoid?: { humanBones?: unknown } };
    VRM?: { humanoid?: { humanBones?: unknown } };
  };
}

const plain = (name: string): string => name.toLowerCase().replace(/[^a-z0-9]/g, '');
const plainBones = new Set([...boneNames].map(plain));

/** VRM 0.x counts the bones of a thumb from the palm. */
const oldName = (bone: string): string =>
  bone.replace('ThumbProximal', 'ThumbIntermediate').replace('ThumbMetacarpal', 'ThumbProximal');

/** VRM requires the bones of both legs. */
const vrmLegs = ['left', 'right'].flatMap((side) => ['UpperLeg', 'LowerLeg', 'Foot'].map((part) => side + part));

/** Returns the index of the node of each bone in a map; of several nodes with one name, one that moves skin. */
function mappedNodes({ nodes = [], skins }: MappedGltf, bones: BoneMap) {
  const joints = new Set(skins?.flatMap((skin) => skin.joints));
  return Object.entries(bones).map(([bone, called]) => {
    const named = nodes.flatMap(({ name }, node) => (name === called ? [node] : []));
    const node = named.find((each) => joints.has(each)) ?? named[0];
    if (node === undefined) throw new Error(`bones.${bone}: no node is called “${called}”`);
    return { bone, node };
  });
}

/**
 * Replaces the humanoid that a VRM states by a map. Returns false if the file is no VRM. Throws where the map names a
 * missing node, or leaves out a bone that VRM requires.
 */
export function setVrmBones(json: MappedGltf, bones: BoneMap): boolean {
  const { VRMC_vrm: vrm, VRM: oldVrm } = json.extensions ?? {};
  if (!vrm && !oldVrm) return false;
  const legs = vrmLegs.filter((bone) => !(bone in bones));
  if (legs.length > 0) throw new Error(`a VRM needs its legs: no ${legs.join(', no ')}`);
  const mapped = mappedNodes(json, bones);
  if (vrm)
    vrm.humanoid = {
      ...vrm.humanoid,
      humanBones: Object.fromEntries(mapped.map(({ bone, node }) => [bone, { node }])),
    };
  if (oldVrm)
    oldVrm.humanoid = {
      ...oldVrm.humanoid,
      humanBones: mapped.map(({ bone, node }) => ({ bone: oldName(bone), node })),
    };
  return true;
}

/**
 * Returns the GLB file with the bones of this map, so that it can be read without the map: in the humanoid of a VRM,
 * else as the names of the nodes. Rejects if the map names a missing node, or the file is not a GLB.
 */
export async function withNamedBones(bytes: ArrayBuffer, bones: BoneMap): Promise<ArrayBuffer> {
  const chunks = readGlbChunks(new Uint8Array(bytes));
  if (!chunks) throw new Error('no GLB file');
  const json = JSON.parse(chunks.json) as MappedGltf;
  if (!setVrmBones(json, bones)) {
    const nodes = json.nodes ?? [];
    const mapped = mappedNodes(json, bones);
    for (const node of nodes) {
      // Other nodes with the name of a bone are renamed.
      if (node.name !== undefined && plainBones.has(plain(node.name))) node.name = `not ${node.name} here`;
    }
    for (const { bone, node } of mapped) nodes[node]!.name = bone;
  }
  return new Blob([...packGlb(json, [chunks.binary as Uint8Array<ArrayBuffer>])]).arrayBuffer();
}
