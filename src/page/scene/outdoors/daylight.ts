import { Quaternion, Vector3 } from 'three';
import type { Transform } from 'threepoint/math';
import type { Quality } from '../renderer';
import type { Lighting } from '../surroundings';
import { createEnvironmentScene } from './environment-scene';
import { hazeColor } from './sky';

/** The daylight of one place; arena frame. */
export interface Daylight {
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
    rim: { color: '#cfe2ff', intensity: 0.5, from: inFloor(new Vector3(-3, 2.6, 1)).toArray() },
    front: { color: '#e6efff', intensity: 0.55, from: inFloor(new Vector3(-1.2, 1.6, -2.5)).toArray() },
    fill: { sky: '#cfe3fb', ground: groundColor, intensity: high ? skyIntensity : skyIntensity + 0.35 },
    shadow: { halfSize: shadows.halfSize, resolution: 2048, softness: 3, centre: { x: middle.x, z: middle.z } },
    fog: { color: hazeColor, near: 16, far: 95 },
    environment: () => createEnvironmentScene(sun),
    environmentIntensity: 0.4,
    contactShadow: high ? 0.4 : 0.6,
  };
}
