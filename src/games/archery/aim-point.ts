import { addScaled, distance, dot, scale, subtract, type Vec3 } from 'threepoint/math';
import { positionAt } from '../ballistics';
import type { BowView, Target } from './archery-state';
import { arrowLength, arrowSpeed, minimumDraw } from './bow';
import { firstHit } from './flight';
import { walls } from './rules';

/** Distance of the aim point for a ray into the sky [m]. */
const farthest = 14;

/** What a ray aims at. */
interface Aim {
  readonly point: Vec3;
  /** From the origin of the ray [m]. */
  readonly distance: number;
  /** The index of the target; null: none. */
  readonly target: number | null;
}

/**
 * Returns what a ray (unit direction, arena frame) aims at: the nearest target, else the ground, else a point as far
 * away as the range is long.
 */
export function aimOf(origin: Vec3, direction: Vec3, targets: readonly Target[]): Aim {
  let nearest = farthest;
  let target: number | null = null;
  if (direction.y < 0) nearest = Math.min(nearest, -origin.y / direction.y);
  for (const [index, { centre, normal, radius }] of targets.entries()) {
    const facing = dot(direction, normal);
    if (facing >= 0) continue;
    const along = dot(subtract(centre, origin), normal) / facing;
    if (along <= 0 || along >= nearest || distance(addScaled(origin, direction, along), centre) > radius) continue;
    nearest = along;
    target = index;
  }
  return { point: addScaled(origin, direction, nearest), distance: nearest, target };
}

/**
 * Returns where the arrow on the string would land if it were released now, arena frame; null: it would return to the
 * quiver.
 */
export function landingPointOf({ arrow, draw }: BowView, targets: readonly Target[]): Vec3 | null {
  if (!arrow || draw < minimumDraw) return null;
  const position = addScaled(arrow.nock, arrow.direction, arrowLength);
  const launch = { position, velocity: scale(arrow.direction, arrowSpeed(draw)) };
  return positionAt(launch, firstHit(launch, targets, walls).after);
}
