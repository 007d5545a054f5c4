import { Color, type Mesh, type MeshLambertMaterial, type PlaneGeometry, type Texture } from 'three';
import { createPaintedGround } from '../../scene/outdoors/painted-ground';
import { field } from './field';

/**
 * Mown stripes on the field, a chalk line across it at each distance [m], a rougher meadow around it; y = 0 of the
 * arena frame.
 */
export function createGround(noise: Texture, distances: readonly number[]): Mesh<PlaneGeometry, MeshLambertMaterial> {
  const colors = {
    lightStripe: new Color('#80a548'),
    darkStripe: new Color('#658c3b'),
    meadow: new Color('#7b944a'),
    straw: new Color('#b3ab62'),
  };
  return createPaintedGround(noise, {
    colors,
    declarations: `uniform vec3 lightStripe; uniform vec3 darkStripe; uniform vec3 meadow; uniform vec3 straw;`,
    paint: `vec4 near = texture2D(noise, onGround * 0.83);
        vec4 wide = texture2D(noise, onGround * 0.031);
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
        float off = 1e3;
        ${distances.map((distance) => `off = min(off, abs(onGround.y + ${distance.toFixed(3)}));`).join('\n        ')}
        float spread = fwidth(onGround.y);
        float reach = max(0.024, spread * 0.6);
        float chalk = (1.0 - smoothstep(reach - spread * 0.5, reach + spread * 0.5, off)) * min(1.0, 0.024 / reach + 0.15);
        chalk *= step(abs(onGround.x), ${(field.halfWidth - 0.25).toFixed(2)}) * (0.75 + 0.6 * blades);
        diffuseColor.rgb *= mix(grass, vec3(0.9, 0.92, 0.84), clamp(chalk, 0.0, 0.85));`,
  });
}
