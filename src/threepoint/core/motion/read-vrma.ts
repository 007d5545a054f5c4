import { isIndex, isObject } from '../json';
import { GltfClip } from './gltf-clip';
import type { ImportedMotion } from './imported-motion';

/**
 * Reads the description and the binary part of a VRM Animation 1.0. Throws a sentence that names the field where they
 * are none.
 */
export function readVrma(description: unknown, binary: Uint8Array): ImportedMotion {
  const extension =
    isObject(description) && isObject(description.extensions) ? description.extensions.VRMC_vrm_animation : null;
  const humanoid = isObject(extension) && isObject(extension.humanoid) ? extension.humanoid.humanBones : null;
  if (!isObject(description) || !isObject(humanoid))
    throw new Error('no VRM Animation: there is no VRMC_vrm_animation with humanBones');
  const clip = new GltfClip(description, binary);
  const names = Object.keys(humanoid);
  const nodes = names.map((name) => {
    const bone = humanoid[name];
    const node = isObject(bone) ? bone.node : undefined;
    if (!isIndex(node) || !clip.nodes[node]) throw new Error(`humanBones.${name} is a node that is not there`);
    return node;
  });
  return clip.motion({ names, nodes }, clip.rest(nodes), Math.max(0, names.indexOf('hips')));
}
