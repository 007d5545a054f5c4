import { reasonOf } from '../../core/errors/reasons';
import { chunksOf } from './glb-chunks';
import { glbOfFile } from './glb-of-file';

/** The parts of a file of glTF that holds motion. */
export interface GltfMotion {
  readonly format: 'gltf';
  readonly description: unknown;
  readonly binary: Uint8Array;
}

/** Whether a file of this name holds motion as glTF, or as FBX, which becomes that. */
export const isGltfMotion = (name: string): boolean => /\.(vrma|glb|fbx)$/i.test(name);

/** Reads a VRM Animation, a GLB or an FBX file with motion. Rejects with a sentence that names the file. */
export async function readGltfMotion(bytes: ArrayBuffer, name: string): Promise<GltfMotion> {
  const chunks = chunksOf(new Uint8Array(await glbOfFile(bytes, name, 'motion')));
  if (!chunks) throw new Error(`${name}: not a GLB file, or truncated`);
  try {
    return { format: 'gltf', description: JSON.parse(chunks.json), binary: chunks.binary };
  } catch (error) {
    throw new Error(`${name}: its description is not JSON: ${reasonOf(error)}`);
  }
}
