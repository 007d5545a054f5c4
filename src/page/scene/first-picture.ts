import {
  type Material,
  type Mesh,
  type Object3D,
  PerspectiveCamera,
  type Scene,
  type ShaderMaterial,
  type Texture,
  type WebGLRenderer,
} from 'three';

const isTexture = (value: unknown): value is Texture =>
  typeof value === 'object' && value !== null && 'isTexture' in value;

/** Every picture on the surfaces under an object, those of shaders too. */
function texturesOf(object: Object3D): Set<Texture> {
  const textures = new Set<Texture>();
  const take = (material: Material) => {
    const uniforms = Object.values((material as Partial<ShaderMaterial>).uniforms ?? {});
    for (const value of [...Object.values(material), ...uniforms.map((uniform) => uniform.value)]) {
      if (isTexture(value)) textures.add(value);
    }
  };
  object.traverse((node) => {
    if (!('isMesh' in node)) return;
    for (const material of [(node as Mesh).material].flat()) take(material);
  });
  return textures;
}

const nextTurn = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

/**
 * Brings what an object needs to the graphics device before it is in the scene: its pictures one at a time, and its
 * programs while the device compiles them by itself. Its first picture waits for neither.
 */
export async function prepareFirstPicture(renderer: WebGLRenderer, scene: Scene, object: Object3D): Promise<void> {
  for (const texture of texturesOf(object)) {
    renderer.initTexture(texture);
    await nextTurn();
  }
  await renderer.compileAsync(object, new PerspectiveCamera(), scene);
}
