import { conjugate, type Pose, rotate, subtract, type Vec3 } from 'threepoint/math';

/** Describes the direction from a head to a point in words; height is ignored. */
export function directionText(head: Pose<'arena'>, point: Vec3): string {
  const seen = rotate(conjugate(head.orientation), subtract(point, head.position));
  const degrees = (Math.atan2(seen.x, -seen.z) * 180) / Math.PI;
  const side = degrees < 0 ? 'left' : 'right';
  const off = Math.abs(degrees);
  if (off < 12) return 'ahead';
  if (off < 60) return `ahead to the ${side}`;
  if (off < 120) return `to the ${side}`;
  if (off < 168) return `behind to the ${side}`;
  return 'behind you';
}
