import { type Mesh, type Object3D, PerspectiveCamera, type Scene, type Texture, type WebGLRenderer } from 'three';
import { texturesOf } from './material-textures';

const nextTurn = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

/**
 * Brings what an object needs to the graphics device before it is in the scene: its pictures one at a time, and its
 * programs while the device compiles them by itself. Its first picture waits for neither.
 */
export async function uploadToGpu(renderer: WebGLRenderer, scene: Scene, object: Object3D): Promise<void> {
  const textures = new Set<Texture>();
  object.traverse((node) => {
    if (!('isMesh' in node)) return;
    for (const material of [(node as Mesh).material].flat())
      for (const each of texturesOf(material)) textures.add(each);
  });
  for (const texture of textures) {
    renderer.initTexture(texture);
    await nextTurn();
  }
  await renderer.compileAsync(object, new PerspectiveCamera(), scene);
}
