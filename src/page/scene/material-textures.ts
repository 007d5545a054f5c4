import type { Material, ShaderMaterial, Texture } from 'three';

const isTexture = (value: unknown): value is Texture =>
  typeof value === 'object' && value !== null && 'isTexture' in value;

/** Returns every picture of a material, those of a shader's uniforms too. */
export function texturesOf(material: Material): Texture[] {
  const uniforms = Object.values((material as Partial<ShaderMaterial>).uniforms ?? {});
  return [...Object.values(material), ...uniforms.map(({ value }) => value)].filter(isTexture);
}
