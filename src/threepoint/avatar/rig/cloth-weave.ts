import type { WebGLProgramParametersWithUniforms } from 'three';

/** Extends the program of a material that is about to be compiled. */
export type ClothWeave = (shader: Pick<WebGLProgramParametersWithUniforms, 'vertexShader' | 'fragmentShader'>) => void;

/** The weave of the materials of the project's own people, as the red channel of their surfaces; others have 0. */
export const weaves: Readonly<Record<string, number>> = { Top: 1, Bottom: 0.5 };

const restVaryings = /* glsl */ `
  varying vec3 vRestPosition;
  varying vec3 vRestNormal;
`;

/**
 * Computes the height of cloth, 0 to 1, at a place of the body at rest [m]: V-shaped stitches of a knit, or ribs of a
 * twill. Three views along the axes are mixed by the normal, because bodies have no texture coordinates.
 */
const clothHeight = /* glsl */ `
  const vec2 stitch = vec2(0.0064, 0.0051);
  const float rib = 0.0026;

  float knitHeight(vec2 place) {
    vec2 at = place / stitch;
    float across = abs(fract(at.x) - 0.5) * 2.0;
    float along = 0.5 + 0.5 * cos(6.2832 * (at.y + 0.55 * across));
    return (0.35 + 0.65 * along) * (1.0 - pow(across, 4.0)) * (1.0 - 0.5 * pow(1.0 - across, 6.0));
  }

  float weaveHeight(vec2 place, bool isKnit) {
    return isKnit ? knitHeight(place) : 0.5 + 0.5 * cos(6.2832 * (place.x + place.y) / rib);
  }

  float clothHeight(vec3 place, vec3 shares, bool isKnit) {
    return shares.x * weaveHeight(place.zy, isKnit)
      + shares.y * weaveHeight(place.xz, isKnit)
      + shares.z * weaveHeight(place.xy, isKnit);
  }
`;

/** Bends the normals of cloth and darkens its grooves where they are a few pixels wide. */
const bendNormals = /* glsl */ `
  float woven = texture2D(roughnessMap, vRoughnessMapUv).r;
  vec3 restX = dFdx(vRestPosition);
  vec3 restY = dFdy(vRestPosition);
  bool isKnit = woven > 0.75;
  float pixelsAPeriod = (isKnit ? stitch.y : rib) / max(length(restX), length(restY));
  float visible = smoothstep(2.3, 5.0, pixelsAPeriod);
  if (woven > 0.0 && visible > 0.0) {
    vec3 shares = pow(abs(normalize(vRestNormal)), vec3(6.0));
    shares /= shares.x + shares.y + shares.z;
    float height = clothHeight(vRestPosition, shares, isKnit);
    float heightX = clothHeight(vRestPosition + restX, shares, isKnit) - height;
    float heightY = clothHeight(vRestPosition + restY, shares, isKnit) - height;
    float depth = visible * (isKnit ? 0.0009 : 0.0003);
    vec3 alongX = dFdx(-vViewPosition);
    vec3 alongY = dFdy(-vViewPosition);
    vec3 slopeX = cross(alongY, normal);
    float area = dot(alongX, slopeX) * faceDirection;
    vec3 gradient = sign(area) * depth * (heightX * slopeX + heightY * cross(normal, alongX));
    normal = normalize(abs(area) * normal - gradient);
    diffuseColor.rgb *= 1.0 - 0.25 * visible * (1.0 - height);
  }
`;

const after = (shader: string, chunk: string, added: string): string => {
  const include = `#include <${chunk}>`;
  if (!shader.includes(include)) throw new Error(`avatar/cloth-weave: three's program has no ${include}`);
  return shader.replace(include, `${include}\n${added}`);
};

/** Draws the weave of cloth without a texture of it: a knit and a twill. */
export const weaveCloth: ClothWeave = (shader) => {
  const passRest = 'vRestPosition = position;\nvRestNormal = normal;';
  shader.vertexShader = after(after(shader.vertexShader, 'common', restVaryings), 'begin_vertex', passRest);
  const inFragment = after(shader.fragmentShader, 'common', restVaryings + clothHeight);
  shader.fragmentShader = after(inFragment, 'normal_fragment_maps', bendNormals);
};
