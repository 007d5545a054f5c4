import { addScaled, distance, dot, subtract, type Vec3 } from 'threepoint/core/math/vec3';
import type { Target } from './archery-state';

/** How far away an archer aims who points at the sky [m]. */
const farthest = 14;

/**
 * What a ray (unit direction, arena frame) points at: the nearest target in its way, else the ground, else a place as far away
 * as the range is long.
 */
export function aimPoint(origin: Vec3, direction: Vec3, targets: readonly Target[]): Vec3 {
  let nearest = farthest;
  if (direction.y < 0) nearest = Math.min(nearest, -origin.y / direction.y);
  for (const { centre, normal, radius } of targets) {
    const facing = dot(direction, normal);
    if (facing >= 0) continue;
    const along = dot(subtract(centre, origin), normal) / facing;
    if (along > 0 && along < nearest && distance(addScaled(origin, direction, along), centre) <= radius)
      nearest = along;
  }
  return addScaled(origin, direction, nearest);
}
