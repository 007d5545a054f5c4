import { addScaled, distance, dot, subtract, type Vec3 } from 'threepoint/core/math/vec3';
import type { Target } from './archery-state';

/** Distance of the aim point for a ray into the sky [m]. */
const farthest = 14;

/**
 * Returns the point at which a ray (unit direction, arena frame) aims: on the nearest target, else on the ground, else
 * as far away as the range is long.
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
