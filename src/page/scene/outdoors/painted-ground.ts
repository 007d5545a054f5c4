import { type Color, Mesh, MeshLambertMaterial, PlaneGeometry, type Texture } from 'three';

/** Half the side of the ground [m]; the fog hides its edge. */
const half = 85;

/** What paints a ground, in GLSL. */
interface GroundPaint {
  readonly colors: Readonly<Record<string, Color | readonly Color[]>>;
  /** Uniforms of the colours, and functions. */
  readonly declarations: string;
  /** Multiplies `diffuseColor`; `onGround` is x and z [m], `noise` the texture. */
  readonly paint: string;
}

/** Creates flat ground at y = 0 of the arena frame, coloured by a shader. */
export function createPaintedGround(
  noise: Texture,
  { colors, declarations, paint }: GroundPaint,
): Mesh<PlaneGeometry, MeshLambertMaterial> {
  // Boards and lines lie millimetres above it: depths interpolated over so large a triangle are not as exact as that.
  const material = new MeshLambertMaterial({
    color: '#ffffff',
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 16,
  });
  const uniforms = Object.fromEntries(Object.entries({ noise, ...colors }).map(([name, value]) => [name, { value }]));
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nvarying vec2 onGround;')
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nonGround = position.xz;');
    shader.fragmentShader = shader.fragmentShader
      .replace(
        '#include <common>',
        `#include <common>
        varying vec2 onGround;
        uniform sampler2D noise;
        ${declarations}`,
      )
      .replace('#include <map_fragment>', paint);
  };
  // three knows a changed shader by the text of the function above, which is the same for every paint.
  material.customProgramCacheKey = () => declarations + paint;
  const ground = new Mesh(new PlaneGeometry(2 * half, 2 * half).rotateX(-Math.PI / 2), material);
  ground.name = 'ground';
  ground.receiveShadow = true;
  return ground;
}
