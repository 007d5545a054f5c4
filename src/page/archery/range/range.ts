import { Group, type Object3D, Vector3 } from 'three';
import { makeTransform } from 'threepoint/math';
import { mergeMeshes } from '../../scene/merge-meshes';
import { daylight } from '../../scene/outdoors/daylight';
import { createLandscape } from '../../scene/outdoors/landscape';
import { createNoiseTexture } from '../../scene/outdoors/noise-texture';
import { createSky } from '../../scene/outdoors/sky';
import type { Quality } from '../../scene/renderer';
import { createBackstop } from './backstop';
import { createDistanceSigns } from './distance-signs';
import { createGround } from './ground';
import { createTufts } from './tufts';
import { createZone } from './zone';

/**
 * Towards the sun, arena frame: behind the archer's right shoulder, so that the targets are lit and shadows fall ahead.
 */
const towardsSun = new Vector3(8.5, 11, 7.5);

/** Builds the place where archery is played, instead of the studio; arena frame. Signs stand at these distances [m]. */
export function createRange(quality: Quality, distances: readonly number[]) {
  const object = new Group();
  object.name = 'archery range';
  const noise = createNoiseTexture(quality);
  const zone = createZone();
  const around = new Group();
  around.add(createLandscape(quality), createBackstop(quality));
  mergeMeshes(around);
  const scenery: Object3D[] = [createSky(noise, towardsSun, quality), createGround(noise, distances), around];
  if (quality === 'high') scenery.push(createTufts());
  object.add(...scenery, createDistanceSigns(distances, quality), zone.object);
  return {
    object,
    scenery,
    lighting: daylight(
      {
        quality,
        towardsSun,
        sunIntensity: 2.7,
        skyIntensity: 0.85,
        groundColor: '#6f7f45',
        shadows: { middle: new Vector3(0, 0, -5), halfSize: 7.4 },
      },
      makeTransform<'floor', 'arena'>(),
    ),
    setZoneWarning: zone.setWarning,
    /** Updates animations to a time [s]. */
    animate: zone.animate,
  };
}
