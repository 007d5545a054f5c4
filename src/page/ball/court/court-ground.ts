import { Color, type Mesh, type MeshLambertMaterial, type PlaneGeometry, type Texture } from 'three';
import { stations } from 'threepoint-games/ball';
import { seatLooks } from '../../people/view/seat-looks';
import { createPaintedGround } from '../../scene/outdoors/painted-ground';
import { court } from './court-plan';

/** A painted hard court in a meadow: lane, lines, a metre scale and the players' marks; y = 0 of the arena frame. */
export function createCourtGround(noise: Texture): Mesh<PlaneGeometry, MeshLambertMaterial> {
  const colors = {
    meadow: new Color('#7b9a48'),
    straw: new Color('#a9a85f'),
    clay: new Color('#b5714f'),
    lane: new Color('#3f7193'),
    chalk: new Color('#eef1ea'),
    pads: seatLooks.map(({ color }) => new Color(color)),
  };
  const fixed = (value: number) => value.toFixed(3);
  const pads = stations
    .map(
      ({ position }, index) => `paint = pad(paint, vec2(${fixed(position.x)}, ${fixed(position.z)}), pads[${index}]);`,
    )
    .join('\n        ');
  return createPaintedGround(noise, {
    colors,
    declarations: `uniform vec3 meadow; uniform vec3 straw; uniform vec3 clay; uniform vec3 lane; uniform vec3 chalk;
        uniform vec3 pads[${stations.length}];
        // How far outside a rectangle, along the axis that is furthest out.
        float outside(vec2 at, float halfWidth, float near, float far) {
          return max(abs(at.x) - halfWidth, max(far - at.y, at.y - near));
        }
        // A line of paint about 0: never thinner than a pixel, only fainter.
        float line(float off, float halfWidth) {
          float spread = fwidth(off);
          float reach = max(halfWidth, 0.6 * spread);
          return (1.0 - smoothstep(reach - 0.5 * spread, reach + 0.5 * spread, abs(off))) * min(1.0, halfWidth / reach + 0.15);
        }
        vec3 pad(vec3 under, vec2 middle, vec3 color) {
          float far = length(onGround - middle);
          float edge = fwidth(far);
          vec3 painted = mix(under, color, 1.0 - smoothstep(${fixed(court.padRadius)} - edge, ${fixed(court.padRadius)} + edge, far));
          return mix(painted, chalk, line(far - ${fixed(court.padRadius)}, 0.022));
        }`,
    paint: `vec4 near = texture2D(noise, onGround * 0.83);
        vec4 wide = texture2D(noise, onGround * 0.031);
        vec3 grass = mix(meadow, straw, smoothstep(0.45, 0.78, wide.r + 0.25 * (near.g - 0.5)));
        grass *= 1.0 + 0.9 * (near.b - 0.42);
        float offCourt = outside(onGround, ${fixed(court.halfWidth)}, ${fixed(court.near)}, ${fixed(court.far)});
        float offLane = outside(onGround, ${fixed(court.laneHalfWidth)}, ${fixed(court.laneNear)}, ${fixed(court.laneFar)});
        float laneEdge = fwidth(offLane);
        vec3 paint = mix(lane, clay, smoothstep(-laneEdge, laneEdge, offLane));
        // Worn and sunned a little, as paint on asphalt is.
        paint *= 0.93 + 0.16 * wide.g + 0.10 * (near.g - 0.5);
        float lines = max(line(offLane, 0.03), line(offCourt + 0.16, 0.03));
        // A mark each metre from the throwers' line on.
        float metres = -onGround.y;
        float tick = line(abs(fract(metres + 0.5) - 0.5), 0.016) * step(abs(abs(onGround.x) - 1.60), 0.13) * step(0.5, metres) * step(metres, 5.5);
        lines = max(lines, tick);
        lines = max(lines, line(onGround.y + 0.75, 0.025) * step(abs(onGround.x), ${fixed(court.laneHalfWidth)}));
        paint = mix(paint, chalk, lines * 0.92);
        ${pads}
        float border = smoothstep(-0.03, 0.05, offCourt + (near.g - 0.5) * 0.12);
        diffuseColor.rgb *= mix(paint, grass, border);`,
  });
}
