import { BackSide, Color, Mesh, ShaderMaterial, SphereGeometry, type Texture, type Vector3 } from 'three';
import type { Quality } from '../renderer';

/** The colour of the horizon and of the fog. */
export const hazeColor = '#dfe9ec';
const zenithColor = '#3f7fc4';

/**
 * A summer morning: blue overhead, haze at the horizon, a soft sun with its glow, thin clouds. Drawn behind everything.
 */
export function createSky(noise: Texture, towardsSun: Vector3, quality: Quality): Mesh<SphereGeometry, ShaderMaterial> {
  const material = new ShaderMaterial({
    side: BackSide,
    depthWrite: false,
    depthTest: false,
    fog: false,
    uniforms: {
      haze: { value: new Color(hazeColor) },
      middle: { value: new Color('#8fc0e8') },
      zenith: { value: new Color(zenithColor) },
      glow: { value: new Color('#fff0cf') },
      towardsSun: { value: towardsSun.clone().normalize() },
      noise: { value: noise },
    },
    vertexShader: `varying vec3 direction;
      void main() {
        direction = normalize(position);
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        // A mirror's tilted near plane tilts its far plane too: the sky must not depend on it.
        gl_Position.z = 0.0;
      }`,
    fragmentShader: `varying vec3 direction;
      uniform vec3 haze; uniform vec3 middle; uniform vec3 zenith; uniform vec3 glow; uniform vec3 towardsSun;
      uniform sampler2D noise;
      void main() {
        vec3 gaze = normalize(direction);
        float height = max(gaze.y, 0.0);
        vec3 color = mix(haze, middle, smoothstep(0.0, 0.24, height));
        color = mix(color, zenith, smoothstep(0.16, 0.85, height));
        // Clouds lie on a plane overhead and vanish in the haze.
        vec2 onCeiling = gaze.xz / (height + 0.12);
        float wide = texture2D(noise, onCeiling * 0.055 + vec2(0.31, 0.12)).r;
        float fine = ${quality === 'high' ? 'texture2D(noise, onCeiling * 0.16 + vec2(0.7, 0.4)).r' : 'wide'};
        float cloud = smoothstep(0.47, 0.72, wide * 0.68 + fine * 0.32) * smoothstep(0.05, 0.26, height);
        color = mix(color, vec3(1.0, 0.992, 0.975), cloud * 0.8);
        float facing = max(dot(gaze, towardsSun), 0.0);
        color = mix(color, glow, 0.55 * pow(facing, 10.0) + 0.25 * pow(facing, 60.0));
        color = mix(color, vec3(1.0), smoothstep(0.9985, 0.9992, facing));
        gl_FragColor = vec4(color, 1.0);
        // Fog is not tone-mapped; neither is what it fades into.
        #include <colorspace_fragment>
      }`,
  });
  // Ground covers everything further below the horizon.
  const sky = new Mesh(new SphereGeometry(40, 32, 12, 0, 2 * Math.PI, 0, 0.56 * Math.PI), material);
  sky.name = 'sky';
  sky.renderOrder = -2;
  return sky;
}
