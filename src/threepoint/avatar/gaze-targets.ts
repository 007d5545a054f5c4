import type { RemotePerson } from '../core/body/remote-person';
import { transformPoint, untransformPoint } from '../core/math/pose';
import { type Quat, rotateInverse } from '../core/math/quat';
import { copyVec3, subtract, type Vec3, vec3 } from '../core/math/vec3';

/** The angle from where a face points within which its eyes turn to a head [rad], and the largest distance [m]. */
const widest = 0.52;
const farthest = 8;

const place = vec3(0, 0, 0);
const direction = vec3(0, 0, 0);
const nearest = vec3(0, 0, 0);

/**
 * Returns the place that a person looks at: the head among those of the others that the person's face points to
 * most, in the frame of the person's own floor; null: none is before the face. The next call overwrites it.
 */
export function gazeTargetOf<
  Person extends Pick<RemotePerson<unknown, unknown>, 'id' | 'pose' | 'placement' | 'opacity'>,
>({ id, pose, placement }: Person, people: readonly Person[]): Vec3 | null {
  let least = widest;
  for (const other of people) {
    if (other.id === id || other.opacity <= 0) continue;
    transformPoint(other.placement, other.pose.head.position, place);
    untransformPoint(placement, place, place);
    const angle = angleAhead(pose.head.orientation, subtract(place, pose.head.position, direction));
    if (!(angle < least)) continue;
    least = angle;
    copyVec3(place, nearest);
  }
  return least < widest ? nearest : null;
}

/** Returns the angle between a direction and that of a face [rad]; Infinity: too far away; NaN: no direction. */
function angleAhead(face: Quat, towards: Vec3): number {
  rotateInverse(face, towards, direction);
  const distance = Math.hypot(direction.x, direction.y, direction.z);
  return distance > farthest ? Number.POSITIVE_INFINITY : Math.acos(Math.max(-1, Math.min(1, -direction.z / distance)));
}
