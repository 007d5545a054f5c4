import { Group, Vector3 } from 'three';
import type { Transform } from '../../core/math/pose';
import { disposeTree } from '../../scene/dispose-tree';
import type { Quality } from '../../scene/renderer';
import type { Surroundings } from '../../scene/surroundings';
import { createLandscape } from '../outdoors/landscape';
import { createNoiseTexture } from '../outdoors/noise-texture';
import { createReflected } from '../outdoors/reflected';
import { createSky, hazeColor } from '../outdoors/sky';
import { createCourtFurniture } from './court-furniture';
import { createCourtGround } from './court-ground';

/** The place where the ball game is played; its object holds everything that is given in the arena frame. */
export interface Court {
  readonly object: Group;
  /** The place as it lies in the room of somebody whose floor is there. */
  placed(floorFromArena: Transform<'floor', 'arena'>): Surroundings;
  dispose(): void;
}

/** Towards the sun, arena frame: from the side, so that neither throwers nor holder look into it. */
const towardsSun = new Vector3(9, 11, 1.5);

/** Builds the court for this many balls. */
export function createCourt(quality: Quality, balls: number): Court {
  const object = new Group();
  object.name = 'ball court';
  const noise = createNoiseTexture(quality);
  object.add(
    createSky(noise, towardsSun, quality),
    createCourtGround(noise),
    createLandscape(quality),
    createCourtFurniture(balls),
  );
  return {
    object,
    placed(floorFromArena) {
      object.position.copy(floorFromArena.position);
      object.quaternion.copy(floorFromArena.orientation);
      const inFloor = (x: number, y: number, z: number) => new Vector3(x, y, z).applyQuaternion(object.quaternion);
      const sun = inFloor(...towardsSun.toArray());
      const middle = inFloor(0, 0, -2.5).add(object.position);
      return {
        object,
        lighting: {
          key: { color: '#fff0d6', intensity: quality === 'high' ? 2.6 : 2.5, from: sun.toArray() },
          rim: { color: '#cfe2ff', intensity: 0.55, from: inFloor(-3, 2.6, 1).toArray() },
          front: { color: '#e6efff', intensity: 0.5, from: inFloor(-1.2, 1.6, -2.5).toArray() },
          fill: { sky: '#cfe3fb', ground: '#8a7a5a', intensity: quality === 'high' ? 0.9 : 1.25 },
          shadow: { halfSize: 6.2, resolution: 2048, softness: 3, centre: { x: middle.x, z: middle.z } },
          fog: { color: hazeColor, near: 16, far: 95 },
          reflected: () => createReflected(sun),
          reflectedIntensity: 0.4,
          contactShadow: quality === 'high' ? 0.4 : 0.6,
        },
      };
    },
    dispose() {
      object.removeFromParent();
      disposeTree(object);
      noise.dispose();
    },
  };
}
