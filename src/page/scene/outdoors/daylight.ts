import {
  BackSide,
  Color,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  Quaternion,
  Scene,
  ShaderMaterial,
  SphereGeometry,
  Vector3,
} from 'three';
import type { Transform } from 'threepoint/math';
import type { Quality } from '../renderer';
import type { Lighting } from '../surroundings';
import { hazeColor } from './sky';

/** The daylight of one place; arena frame. */
interface Daylight {
  readonly quality: Quality;
  readonly towardsSun: Vector3;
  readonly sunIntensity: number;
  readonly skyIntensity: number;
  /** The colour of the light that the ground reflects. */
  readonly groundColor: string;
  /** Shadows fall within this square [m]. */
  readonly shadows: { readonly middle: Vector3; readonly halfSize: number };
}

/** Returns the lighting by a warm sun over a hazy horizon, in the floor frame of the viewer. */
export function daylight(place: Daylight, { position, orientation }: Transform<'floor', 'arena'>): Lighting {
  const { quality, towardsSun, sunIntensity, skyIntensity, groundColor, shadows } = place;
  const high = quality === 'high';
  const turn = new Quaternion(orientation.x, orientation.y, orientation.z, orientation.w);
  const inFloor = (direction: Vector3) => direction.clone().applyQuaternion(turn);
  const sun = inFloor(towardsSun);
  const middle = inFloor(shadows.middle).add(position);
  return {
    // Without shadows and reflections the sky has to light what the sun does not.
    key: { color: '#fff0d6', intensity: high ? sunIntensity : sunIntensity - 0.1, from: sun.toArray() },
    rim: { color: '#cfe2ff', intensity: 1.1, from: inFloor(new Vector3(-3, 2.6, 1)).toArray() },
    front: { color: '#e6efff', intensity: 0.55, from: inFloor(new Vector3(-1.2, 1.6, -2.5)).toArray() },
    fill: { sky: '#cfe3fb', ground: groundColor, intensity: high ? skyIntensity : skyIntensity + 0.35 },
    shadow: { halfSize: shadows.halfSize, resolution: 2048, softness: 3, centre: { x: middle.x, z: middle.z } },
    fog: { color: hazeColor, near: 16, far: 95 },
    environment: () => createEnvironmentScene(sun),
    environmentIntensity: 0.4,
    contactShadow: high ? 0.4 : 0.6,
  };
}

/** Sky above, grass below, the sun at its place, as a bow's varnish or an avatar's eyes reflect them. */
function createEnvironmentScene(sun: Vector3): Scene {
  const reflected = new Scene();
  const dome = new Mesh(
    new SphereGeometry(10, 24, 16),
    new ShaderMaterial({
      side: BackSide,
      uniforms: {
        sky: { value: new Color('#9cc6ee') },
        haze: { value: new Color('#eef3f0').multiplyScalar(1.15) },
        grass: { value: new Color('#5f7a35').multiplyScalar(0.7) },
      },
      vertexShader: `varying vec3 direction;
        void main() { direction = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
      fragmentShader: `varying vec3 direction; uniform vec3 sky; uniform vec3 haze; uniform vec3 grass;
        void main() {
          float height = normalize(direction).y;
          vec3 above = mix(haze, sky, smoothstep(0.0, 0.5, height));
          gl_FragColor = vec4(mix(grass, above, smoothstep(-0.06, 0.03, height)), 1.0);
        }`,
    }),
  );
  const disc = new Mesh(
    new PlaneGeometry(3.2, 3.2),
    new MeshBasicMaterial({ color: new Color('#fff2d8').multiplyScalar(11), side: 2 }),
  );
  disc.position.copy(sun).setLength(8);
  disc.lookAt(0, 0, 0);
  reflected.add(dome, disc);
  return reflected;
}
