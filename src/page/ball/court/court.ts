import { Group, Vector3 } from 'three';
import type { Transform } from 'threepoint/math';
import { mergeMeshes } from '../../scene/merge-meshes';
import { daylight } from '../../scene/outdoors/daylight';
import { createLandscape } from '../../scene/outdoors/landscape';
import { createNoiseTexture } from '../../scene/outdoors/noise-texture';
import { createSky } from '../../scene/outdoors/sky';
import type { Quality } from '../../scene/renderer';
import type { Surroundings } from '../../scene/surroundings';
import { createCourtFurniture } from './court-furniture';
import { createCourtGround } from './court-ground';

/** Towards the sun, arena frame: from the side, so that neither throwers nor holder look into it. */
const towardsSun = new Vector3(9, 11, 1.5);

/**
 * The place where the ball game is played; its object holds everything that is given in the arena frame. Builds the
 * court for this many balls.
 */
export function createCourt(quality: Quality, balls: number) {
  const object = new Group();
  object.name = 'ball court';
  const noise = createNoiseTexture(quality);
  const furniture = createCourtFurniture(balls);
  mergeMeshes(furniture);
  const scenery = [createSky(noise, towardsSun, quality), createCourtGround(noise), createLandscape(quality)];
  object.add(...scenery, furniture);
  return {
    object,
    /** Returns the court for a user's floor frame. */
    placed(floorFromArena: Transform<'floor', 'arena'>): Surroundings {
      object.position.copy(floorFromArena.position);
      object.quaternion.copy(floorFromArena.orientation);
      return {
        object,
        scenery,
        lighting: daylight(
          {
            quality,
            towardsSun,
            sunIntensity: 2.6,
            skyIntensity: 0.9,
            groundColor: '#8a7a5a',
            shadows: { middle: new Vector3(0, 0, -2.5), halfSize: 6.2 },
          },
          floorFromArena,
        ),
      };
    },
  };
}

export type Court = ReturnType<typeof createCourt>;
