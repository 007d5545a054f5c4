import type { Arrow } from '../../core/games/archery/archery-state';
import { positionAt, velocityAt } from '../../core/games/ballistics';
import { addScaled, cross, normalise, scale, up, type Vec3, vec3 } from '../../core/math/vec3';

/** Where an arrow is drawn: its tip and the unit direction it points in; arena frame. */
export interface ArrowPose {
  readonly tip: Vec3;
  readonly direction: Vec3;
}

/** How deep a tip goes into what it hits [m]. */
const depth = { target: 0.085, ground: 0.07, wall: 0.2 } as const;

/** Seconds in which half of the wobble dies away, its swings per second, and its first swing [rad]. */
const wobble = { halfLife: 0.09, frequency: 15, angle: 0.055 };

/** The arrow's pose at a time of the match: on its parabola until it lands, then stuck where it landed, trembling for a moment. */
export function arrowPose({ id, release, landing }: Arrow, time: number): ArrowPose {
  if (!landing || time < landing.time) {
    const after = Math.max(0, time - release.time);
    return { tip: positionAt(release, after), direction: normalise(velocityAt(release, after)) };
  }
  const since = time - landing.time;
  const swing = wobble.angle * 0.5 ** (since / wobble.halfLife) * Math.sin(2 * Math.PI * wobble.frequency * since);
  const side = normalise(cross(landing.direction, up), vec3(1, 0, 0));
  const rise = cross(side, landing.direction);
  const turn = id * 2.4;
  const aside = addScaled(scale(side, Math.cos(turn)), rise, Math.sin(turn));
  const direction = normalise(addScaled(landing.direction, aside, swing));
  return { tip: addScaled(landing.position, direction, depth[landing.on]), direction };
}
