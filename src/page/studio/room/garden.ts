import { Color, Group, Vector3 } from 'three';
import { createLandscape } from '../../scene/outdoors/landscape';
import { createNoiseTexture } from '../../scene/outdoors/noise-texture';
import { createPaintedGround } from '../../scene/outdoors/painted-ground';
import { createSky } from '../../scene/outdoors/sky';
import type { Quality } from '../../scene/renderer';
import { gardenDepth, towardsSun } from './room-plan';

/** Builds the garden before the windows of the studio; floor frame. */
export function createGarden(quality: Quality): Group {
  const noise = createNoiseTexture(quality);
  const lawn = createPaintedGround(noise, {
    colors: { mown: new Color('#739a45'), meadow: new Color('#86a04f') },
    declarations: 'uniform vec3 mown; uniform vec3 meadow;',
    paint: `vec4 near = texture2D(noise, onGround * 0.83);
        vec4 wide = texture2D(noise, onGround * 0.031);
        vec3 grass = mix(mown, meadow, smoothstep(0.42, 0.75, wide.r + 0.25 * (near.g - 0.5)));
        diffuseColor.rgb *= grass * (1.0 + 0.7 * (near.b - 0.42));`,
  });
  const garden = new Group();
  garden.name = 'garden';
  garden.add(lawn, createLandscape(quality));
  garden.position.y = -gardenDepth;
  const whole = new Group();
  whole.add(createSky(noise, new Vector3(...towardsSun), quality), garden);
  return whole;
}
