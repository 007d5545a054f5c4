import { type BoneMap, boneNames } from '../../core/humanoid/bones';
import { packGlb } from '../../core/motion/gltf';
import { chunksOf } from '../file/glb-chunks';

interface NamedNodes {
  [field: string]: unknown;
  nodes?: { name?: string }[];
  skins?: { joints: number[] }[];
}

const plain = (name: string): string => name.toLowerCase().replace(/[^a-z0-9]/g, '');
const plainBones = new Set([...boneNames].map(plain));

/**
 * Returns the GLB file with its bones renamed to VRM's names by this map, so that a page needs no map to read it.
 * Rejects where the map names a missing node, or the file is not a GLB.
 */
export async function withNamedBones(bytes: ArrayBuffer, bones: BoneMap): Promise<ArrayBuffer> {
  const chunks = chunksOf(new Uint8Array(bytes));
  if (!chunks) throw new Error('no GLB file');
  const json = JSON.parse(chunks.json) as NamedNodes;
  const nodes = json.nodes ?? [];
  const joints = new Set(json.skins?.flatMap((skin) => skin.joints));
  const mapped = Object.entries(bones).map(([bone, called]) => {
    const named = nodes.filter(({ name }) => name === called);
    const node = named.find((each) => joints.has(nodes.indexOf(each))) ?? named[0];
    if (!node) throw new Error(`bones.${bone}: no node is called “${called}”`);
    return { bone, node };
  });
  for (const node of nodes) {
    // What is called as a bone and is none of them would be taken for one.
    if (node.name !== undefined && plainBones.has(plain(node.name))) node.name = `not ${node.name} here`;
  }
  for (const { bone, node } of mapped) node.name = bone;
  return new Blob([...packGlb(json, [chunks.binary as Uint8Array<ArrayBuffer>])]).arrayBuffer();
}
