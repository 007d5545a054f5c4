import { reasonOf } from '../../core/errors/reasons';
import { isObject } from '../../core/json';
import { objects } from '../../core/motion/gltf-clip';
import { convertToGlb } from './convert-to-glb';
import { readGlbChunks } from './glb-chunks';

interface GltfMotion {
  readonly format: 'gltf';
  readonly description: unknown;
  readonly binary: Uint8Array;
}

/** Returns whether a file with this name is glTF, or FBX, which is converted to glTF. */
export const isGltfMotion = (name: string): boolean => /\.(vrma|glb|gltf|fbx)$/i.test(name);

function parsed(text: string, name: string): unknown {
  try {
    return JSON.parse(text);
  } catch (error) {
    throw new Error(`${name}: its description is not JSON: ${reasonOf(error)}`);
  }
}

/** Reads a VRM Animation, a GLB, glTF or FBX file with motion. Rejects with a sentence that names the file. */
export async function readGltfMotion(bytes: ArrayBuffer, name: string): Promise<GltfMotion> {
  const chunks = readGlbChunks(new Uint8Array(await convertToGlb(bytes, name, 'motion')));
  if (!chunks) throw new Error(`${name}: not a glTF file, or truncated`);
  const description = parsed(chunks.json, name);
  if (isObject(description) && objects(description.buffers).some(({ uri }) => uri !== undefined))
    throw new Error(`${name}: its numbers are in other files; save it as GLB, which contains everything`);
  return { format: 'gltf', description, binary: chunks.binary };
}
