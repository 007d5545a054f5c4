import { Color, Mesh, MeshLambertMaterial, PlaneGeometry, type Texture } from 'three';
import type { Quality } from '../../scene/renderer';
import { field } from './field';

const half = 85;

/** Mown stripes on the field, a chalk line across it at each distance [m], a rougher meadow around it; y = 0 of the arena frame. */
export function createGround(
  noise: Texture,
  distances: readonly number[],
  quality: Quality,
): Mesh<PlaneGeometry, MeshLambertMaterial> {
  const material = new MeshLambertMaterial({ color: '#ffffff' });
  const uniforms = {
    noise: { value: noise },
    lightStripe: { value: new Color('#86b04a') },
    darkStripe: { value: new Color('#6b9a3d') },
    meadow: { value: new Color('#7f9c4c') },
    straw: { value: new Color('#b3ab62') },
  };
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
        uniform vec3 lightStripe; uniform vec3 darkStripe; uniform vec3 meadow; uniform vec3 straw;
        float chalkLine(float off, float spread) {
          float half_ = max(0.024, spread * 0.6);
          return (1.0 - smoothstep(half_ - spread * 0.5, half_ + spread * 0.5, abs(off))) * min(1.0, 0.024 / half_ + 0.15);
        }`,
      )
      .replace(
        '#include <map_fragment>',
        `vec4 near = texture2D(noise, onGround * 0.83);
        vec4 wide = ${quality === 'high' ? 'texture2D(noise, onGround * 0.031)' : 'near'};
        // A mower's stripes along the shooting direction; their edges are a little ragged and never alias.
        float across = onGround.x / ${field.stripe.toFixed(3)} + (near.g - 0.5) * 0.06;
        float edge = max(fwidth(across), 0.02);
        float wave = abs(fract(across * 0.5) - 0.5) * 2.0;
        float stripe = smoothstep(0.5 - edge, 0.5 + edge, wave);
        vec3 mown = mix(lightStripe, darkStripe, stripe);
        mown *= 0.94 + 0.14 * wide.g;
        vec3 rough = mix(meadow, straw, smoothstep(0.42, 0.75, wide.r + 0.25 * (near.g - 0.5)));
        float outside = max(abs(onGround.x) - ${field.halfWidth.toFixed(2)}, max(${field.far.toFixed(2)} - onGround.y, onGround.y - ${field.near.toFixed(2)}));
        float border = smoothstep(-0.1, 0.1, outside + (near.g - 0.5) * 0.5);
        vec3 grass = mix(mown, rough, border);
        float blades = near.b - 0.42;
        grass *= 1.0 + blades * mix(0.62, 0.95, border);
        // Chalk: never thinner than a pixel, only fainter.
        float chalk = 0.0;
        float spread = fwidth(onGround.y);
        ${distances.map((distance) => `chalk = max(chalk, chalkLine(onGround.y + ${distance.toFixed(3)}, spread));`).join('\n        ')}
        chalk *= step(abs(onGround.x), ${(field.halfWidth - 0.25).toFixed(2)}) * (0.75 + 0.6 * blades);
        diffuseColor.rgb *= mix(grass, vec3(0.9, 0.92, 0.84), clamp(chalk, 0.0, 0.85));`,
      );
  };
  const ground = new Mesh(new PlaneGeometry(2 * half, 2 * half).rotateX(-Math.PI / 2), material);
  ground.name = 'ground';
  ground.receiveShadow = true;
  return ground;
}
