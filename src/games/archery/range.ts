import { Group, Vector3 } from 'three';
import type { Transform } from '../../core/math/pose';
import { disposeTree } from '../../scene/dispose-tree';
import type { Quality } from '../../scene/renderer';
import type { Surroundings } from '../../scene/surroundings';
import { createLandscape } from '../outdoors/landscape';
import { createNoiseTexture } from '../outdoors/noise-texture';
import { createReflected } from '../outdoors/reflected';
import { createSky, hazeColor } from '../outdoors/sky';
import { createBackstop } from './backstop';
import { createDistanceSigns } from './distance-signs';
import { createGround } from './ground';
import { createTufts } from './tufts';
import { createZone } from './zone';

/** The place where archery is played; stands in for the studio (`arena.setSurroundings`). Its object is in the arena frame, placed in the floor frame. */
export interface Range extends Surroundings {
  readonly object: Group;
  setZoneWarning(on: boolean): void;
  /** Moves what moves by itself; time [s]. */
  animate(time: number): void;
  dispose(): void;
}

/** Towards the sun, arena frame: behind the archer's right shoulder, so that the targets are lit and shadows fall ahead. */
const towardsSun = new Vector3(8.5, 11, 7.5);

/** Builds the range: floorFromArena puts its zone and its direction into the room; signs stand at these distances [m]. */
export function createRange(
  quality: Quality,
  floorFromArena: Transform<'floor', 'arena'>,
  distances: readonly number[],
): Range {
  const object = new Group();
  object.name = 'archery range';
  object.position.copy(floorFromArena.position);
  object.quaternion.copy(floorFromArena.orientation);
  const inFloor = (x: number, y: number, z: number) => new Vector3(x, y, z).applyQuaternion(object.quaternion);
  const noise = createNoiseTexture(quality);
  const zone = createZone();
  object.add(
    createSky(noise, towardsSun, quality),
    createGround(noise, distances),
    createLandscape(quality),
    createBackstop(quality),
    createDistanceSigns(distances, quality),
    zone.object,
  );
  if (quality === 'high') object.add(createTufts());
  const sun = inFloor(...towardsSun.toArray());
  const middle = inFloor(0, 0, -5).add(object.position);
  return {
    object,
    lighting: {
      key: { color: '#fff0d6', intensity: quality === 'high' ? 2.7 : 2.6, from: sun.toArray() },
      rim: { color: '#cfe2ff', intensity: 0.5, from: inFloor(-3, 2.6, 1).toArray() },
      front: { color: '#e6efff', intensity: 0.55, from: inFloor(-1.2, 1.6, -2.5).toArray() },
      fill: { sky: '#cfe3fb', ground: '#6f7f45', intensity: quality === 'high' ? 0.85 : 1.2 },
      shadow: { halfSize: 7.4, resolution: 2048, softness: 3, centre: { x: middle.x, z: middle.z } },
      fog: { color: hazeColor, near: 16, far: 95 },
      reflected: () => createReflected(sun),
      reflectedIntensity: 0.4,
      contactShadow: quality === 'high' ? 0.4 : 0.6,
    },
    setZoneWarning: zone.setWarning,
    animate: zone.animate,
    dispose() {
      object.removeFromParent();
      disposeTree(object);
      noise.dispose();
    },
  };
}
