import { reasonOf } from '../../core/errors/reasons';
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

/** Returns the numbers that a glTF file as text contains. */
async function embeddedNumbers(description: unknown, name: string): Promise<Uint8Array> {
  const { buffers } = (description ?? {}) as { readonly buffers?: readonly { readonly uri?: unknown }[] };
  const uri = Array.isArray(buffers) && buffers.length === 1 ? buffers[0]?.uri : undefined;
  if (typeof uri !== 'string' || !uri.startsWith('data:')) {
    throw new Error(`${name}: its numbers are in other files; save it as GLB, which contains everything`);
  }
  const content = await fetch(uri).catch(() => null);
  if (!content) throw new Error(`${name}: its numbers are not base64`);
  return new Uint8Array(await content.arrayBuffer());
}

/** Reads a VRM Animation, a GLB, glTF or FBX file with motion. Rejects with a sentence that names the file. */
export async function readGltfMotion(bytes: ArrayBuffer, name: string): Promise<GltfMotion> {
  if (/\.gltf$/i.test(name)) {
    const description = parsed(new TextDecoder().decode(bytes), name);
    return { format: 'gltf', description, binary: await embeddedNumbers(description, name) };
  }
  const chunks = readGlbChunks(new Uint8Array(await convertToGlb(bytes, name, 'motion')));
  if (!chunks) throw new Error(`${name}: not a GLB file, or truncated`);
  return { format: 'gltf', description: parsed(chunks.json, name), binary: chunks.binary };
}
