import { addScaled, cross, type MutableVec3, normalise, right, scale, up, type Vec3, vec3 } from 'threepoint/math';
import { positionAt, velocityAt } from 'threepoint-games';
import type { Arrow } from 'threepoint-games/archery';

/** The pose of a drawn arrow: its tip and its unit direction, arena frame. */
export interface ArrowPose {
  readonly tip: Vec3;
  readonly direction: Vec3;
}

/** An arrow pose that its owner overwrites. */
interface MutableArrowPose extends ArrowPose {
  readonly tip: MutableVec3;
  readonly direction: MutableVec3;
}

export const makeArrowPose = (): MutableArrowPose => ({ tip: vec3(0, 0, 0), direction: vec3(0, 0, -1) });

/** How deep a tip goes into what it hits [m]. */
const depth = { target: 0.085, ground: 0.07, wall: 0.2 } as const;

/** The half-life [s], frequency [Hz] and amplitude [rad] of the wobble of an arrow that has landed. */
const wobble = { halfLife: 0.09, frequency: 15, angle: 0.055 };

const side = vec3(0, 0, 0);
const rise = vec3(0, 0, 0);

/**
 * Writes the arrow's pose at a match time into `target`: on its parabola until it lands, then at its landing, where it
 * wobbles for a moment.
 */
export function arrowPose(
  { id, release, landing }: Arrow,
  time: number,
  target: MutableArrowPose = makeArrowPose(),
): MutableArrowPose {
  const { tip, direction } = target;
  if (!landing || time < landing.time) {
    const after = Math.max(0, time - release.time);
    positionAt(release, after, tip);
    normalise(velocityAt(release, after, direction), undefined, direction);
    return target;
  }
  const since = time - landing.time;
  const swing = wobble.angle * 0.5 ** (since / wobble.halfLife) * Math.sin(2 * Math.PI * wobble.frequency * since);
  normalise(cross(landing.direction, up, side), right, side);
  cross(side, landing.direction, rise);
  const turn = id * 2.4;
  const aside = addScaled(scale(side, Math.cos(turn), side), rise, Math.sin(turn), side);
  normalise(addScaled(landing.direction, aside, swing, direction), undefined, direction);
  addScaled(landing.position, direction, depth[landing.on], tip);
  return target;
}
