import { type AnimationClip, type Group, Loader, LoadingManager, Texture } from 'three';
import { FBXLoader } from 'three/addons/loaders/FBXLoader.js';
import { reasonOf } from '../../../core/errors/reasons';
import { checkedFbx } from './check-fbx';
import { glbOfScene, type SceneParts } from './glb-of-scene';

/** Stores the URL of each picture instead of decoding it; the reader of the converted file decodes. */
class PictureAddresses extends Loader<Texture> {
  override load(url: string): Texture {
    const texture = new Texture();
    texture.userData.url = url;
    return texture;
  }
}

/** Returns the picture that a texture of the scene names; null: it lies outside the file. */
async function embeddedPicture({ userData: { url } }: Texture): Promise<Uint8Array<ArrayBuffer> | null> {
  if (typeof url !== 'string' || !/^(blob|data):/.test(url)) return null;
  const picture = await (await fetch(url)).arrayBuffer();
  URL.revokeObjectURL(url);
  return new Uint8Array(picture);
}

/** Reads FBX, binary or text, without a document: in a worker or in Node. */
function sceneOf(bytes: Uint8Array, parts: SceneParts): Group & { readonly animations: readonly AnimationClip[] } {
  const manager = new LoadingManager();
  manager.addHandler(/./, new PictureAddresses(manager));
  return new FBXLoader(manager).parse(checkedFbx(bytes, parts), '');
}

/**
 * Converts FBX into a GLB file. Rejects with a sentence that names the file. `parts`: the parts to keep, a body or its
 * motion.
 */
export async function glbOfFbx(bytes: Uint8Array, name: string, parts: SceneParts): Promise<ArrayBuffer> {
  try {
    return await glbOfScene(sceneOf(bytes, parts), parts, embeddedPicture);
  } catch (error) {
    // The loader reads references between nodes without a check.
    const reason =
      error instanceof TypeError || error instanceof RangeError ? 'its parts do not fit together' : reasonOf(error);
    throw new Error(`${name}: cannot be read as FBX (${reason})`);
  }
}
