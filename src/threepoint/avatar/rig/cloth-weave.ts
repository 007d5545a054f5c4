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
 * Computes the relief of cloth at a place of the body at rest [m]: stitches of a knit or ribs of a twill, and seams at
 * the sides, armholes, shoulders and in the middle of trousers. Bodies have no texture coordinates: three views of the
 * knit along the axes are mixed by the normal, the twill is wound round each leg, and seams lie in planes.
 */
const clothRelief = /* glsl */ `
  const vec2 stitch = vec2(0.0064, 0.0051);
  const float rib = 0.0034;
  const float seamWidth = 0.0034;
  const float armhole = 0.178;
  const float sideOfTrunk = -0.013;
  const float sideOfLeg = -0.006;
  const float legAside = 0.097;
  const float legRadius = 0.07;
  const float crotch = 0.8;
  const float armpit = 1.2;

  float knitHeight(vec2 place) {
    vec2 at = place / stitch;
    float across = abs(fract(at.x) - 0.5) * 2.0;
    float along = 0.5 + 0.5 * cos(6.2832 * (at.y + 0.55 * across));
    return (0.35 + 0.65 * along) * (1.0 - pow(across, 4.0)) * (1.0 - 0.5 * pow(1.0 - across, 6.0));
  }

  float knitHeight(vec3 place, vec3 restNormal) {
    // The columns of stitches run along a sleeve.
    bool onSleeve = abs(place.x) > armhole;
    vec3 at = onSleeve ? place.yxz : place;
    vec3 shares = pow(abs(onSleeve ? restNormal.yxz : restNormal), vec3(6.0));
    return dot(shares, vec3(knitHeight(at.zy), knitHeight(at.xz), knitHeight(at.xy))) / (shares.x + shares.y + shares.z);
  }

  float twillHeight(vec3 place) {
    float around = legRadius * atan(place.z - sideOfLeg, abs(place.x) - legAside);
    return 0.5 + 0.5 * cos(6.2832 * (around + place.y) / rib);
  }

  float seamDistance(vec3 place, bool isAbove, bool isKnit) {
    float aside = abs(place.x);
    float side = abs(place.z - (isKnit ? sideOfTrunk : sideOfLeg));
    if (!isKnit) return place.y > crotch ? min(side, aside) : side;
    float hole = place.y > armpit ? abs(aside - armhole) : 1.0;
    return isAbove && aside > armhole ? hole : min(side, hole);
  }

  // The height of the weave and the depth of a seam, both 0 to 1.
  vec2 clothRelief(vec3 place, vec3 restNormal, bool isKnit, bool isNear) {
    float weave = !isNear ? 0.0 : isKnit ? knitHeight(place, restNormal) : twillHeight(place);
    float across = 2.0 * seamDistance(place, restNormal.y > 0.0, isKnit) / seamWidth;
    return vec2(weave, exp(-across * across));
  }
`;

/** Bends the normals of cloth and darkens its grooves where they are a few pixels wide. */
const bendNormals = /* glsl */ `
  float woven = texture2D(roughnessMap, vRoughnessMapUv).r;
  vec3 restX = dFdx(vRestPosition);
  vec3 restY = dFdy(vRestPosition);
  bool isKnit = woven > 0.75;
  float pixel = max(length(restX), length(restY));
  float seamVisible = smoothstep(0.7, 2.3, seamWidth / pixel);
  if (woven > 0.0 && seamVisible > 0.0) {
    vec3 restNormal = normalize(vRestNormal);
    float weaveVisible = smoothstep(2.3, 5.0, (isKnit ? stitch.y : 0.7 * rib) / pixel);
    bool isNear = weaveVisible > 0.0;
    vec2 relief = clothRelief(vRestPosition, restNormal, isKnit, isNear);
    vec2 depths = vec2(weaveVisible * (isKnit ? 0.0009 : 0.0003), -0.0011 * seamVisible);
    float heightX = dot(depths, clothRelief(vRestPosition + restX, restNormal, isKnit, isNear) - relief);
    float heightY = dot(depths, clothRelief(vRestPosition + restY, restNormal, isKnit, isNear) - relief);
    vec3 alongX = dFdx(-vViewPosition);
    vec3 alongY = dFdy(-vViewPosition);
    vec3 slopeX = cross(alongY, normal);
    float area = dot(alongX, slopeX) * faceDirection;
    vec3 gradient = sign(area) * (heightX * slopeX + heightY * cross(normal, alongX));
    normal = normalize(abs(area) * normal - gradient);
    diffuseColor.rgb *= (1.0 - 0.25 * weaveVisible * (1.0 - relief.x)) * (1.0 - 0.5 * seamVisible * relief.y);
  }
`;

const after = (shader: string, chunk: string, added: string): string => {
  const include = `#include <${chunk}>`;
  if (!shader.includes(include)) throw new Error(`avatar/cloth-weave: three's program has no ${include}`);
  return shader.replace(include, `${include}\n${added}`);
};

/** Draws the weave and the seams of cloth without a texture of it: a knit and a twill. */
export const weaveCloth: ClothWeave = (shader) => {
  const passRest = 'vRestPosition = position;\nvRestNormal = normal;';
  shader.vertexShader = after(after(shader.vertexShader, 'common', restVaryings), 'begin_vertex', passRest);
  const inFragment = after(shader.fragmentShader, 'common', restVaryings + clothRelief);
  shader.fragmentShader = after(inFragment, 'normal_fragment_maps', bendNormals);
};
