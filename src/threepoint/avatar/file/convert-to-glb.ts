import type { SceneParts } from './fbx/glb-of-scene';
import { isFbx } from './fbx/is-fbx';

/** The largest FBX file that is read [MB]. */
const maxMegabytes = 60;

/**
 * Returns a file as GLB: FBX converted, any other as it is. Rejects with a sentence that names the file. `parts`: a
 * body, or the motion of its bones.
 */
export async function convertToGlb(bytes: ArrayBuffer, name: string, parts: SceneParts): Promise<ArrayBuffer> {
  const file = new Uint8Array(bytes);
  if (!isFbx(file, name)) return bytes;
  const megabytes = file.length / 2 ** 20;
  if (megabytes > maxMegabytes) {
    throw new Error(`${name}: ${Math.round(megabytes)} MB; an FBX file may have ${maxMegabytes} MB at most`);
  }
  const { glbOfFbx } = await import('./fbx/read-fbx');
  return glbOfFbx(file, name, parts);
}
