import type { SceneParts } from './fbx/glb-of-scene';
import { isFbx } from './fbx/is-fbx';

/** The largest file that is converted [MB]. */
const maxMegabytes = 60;

/** Returns whether a file is glTF as text, or a GLB file whose description has addresses, which may be data URLs. */
function hasAddresses(file: Uint8Array): boolean {
  if (new TextDecoder().decode(file.subarray(0, 4)) !== 'glTF') return /^[\ufeff\s]*\{/.test(start(file, 100));
  const length = file.length < 20 ? 0 : new DataView(file.buffer, file.byteOffset).getUint32(12, true);
  return start(file, 20 + length).includes('"uri"');
}

const start = (file: Uint8Array, length: number): string => new TextDecoder().decode(file.subarray(0, length));

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
