import type { SceneParts } from './fbx/glb-of-scene';
import { isFbx } from './fbx/is-fbx';
import { readGlbChunks } from './glb-chunks';

/** The largest file that is converted [MB]. */
const maxMegabytes = 60;

/** Returns whether a file is glTF as text, or a GLB file whose description has addresses, which may be data URLs. */
function hasAddresses(file: Uint8Array): boolean {
  const chunks = readGlbChunks(file);
  return chunks
    ? chunks.json.includes('"uri"')
    : /^[\ufeff\s]*\{/.test(new TextDecoder().decode(file.subarray(0, 100)));
}

/**
 * Returns a file as GLB that holds everything itself: FBX converted, data URLs embedded, any other as it is. Rejects
 * with a sentence that names the file. `parts`: a body, or the motion of its bones.
 */
export async function convertToGlb(bytes: ArrayBuffer, name: string, parts: SceneParts): Promise<ArrayBuffer> {
  const file = new Uint8Array(bytes);
  const fbx = isFbx(file, name);
  if (!fbx && !hasAddresses(file)) return bytes;
  const megabytes = file.length / 2 ** 20;
  if (megabytes > maxMegabytes) {
    const kind = fbx ? 'an FBX file' : 'a glTF file with addresses';
    throw new Error(`${name}: ${Math.round(megabytes)} MB; ${kind} may have ${maxMegabytes} MB at most`);
  }
  if (!fbx) return (await import('./embed-data')).embedData(file, name);
  const { glbOfFbx } = await import('./fbx/read-fbx');
  return glbOfFbx(file, name, parts);
}
