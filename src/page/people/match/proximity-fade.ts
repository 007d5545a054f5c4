import type { AvatarPose } from 'threepoint/core';
import { clamp, distance, smoothstep, type Transform, transformPoint, type Vec3, vec3 } from 'threepoint/math';

/** Nearer to the own eyes than the first [m] another body begins to fade; at the second it is gone. */
const fadesFrom = 0.5;
const goneAt = 0.2;
/** The distance of the hips below the head [m], for a body whose trunk was not sent. */
const hipsBelow = 0.62;

const head = vec3(0, 0, 0);
const low = vec3(0, 0, 0);
const hand = vec3(0, 0, 0);

/** From a point to the line between two others [m]. */
function distanceToLine(point: Vec3, from: Vec3, to: Vec3): number {
  const x = to.x - from.x;
  const y = to.y - from.y;
  const z = to.z - from.z;
  const square = x * x + y * y + z * z;
  const along = (point.x - from.x) * x + (point.y - from.y) * y + (point.z - from.z) * z;
  const share = square > 0 ? clamp(along / square, 0, 1) : 0;
  return Math.hypot(point.x - from.x - share * x, point.y - from.y - share * y, point.z - from.z - share * z);
}

/**
 * Returns the opacity of another body for these eyes, floor frame: 1 from half a metre on, 0 where its head, trunk or
 * hands come closer than 0.2 m. `placement`: its floor in the user's floor frame.
 */
export function proximityFade(eyes: Vec3, pose: AvatarPose, placement: Transform<'floor', 'floor'>): number {
  transformPoint(placement, pose.head.position, head);
  if (pose.body) transformPoint(placement, pose.body.hipsPosition, low);
  else {
    low.x = head.x;
    low.y = head.y - hipsBelow;
    low.z = head.z;
  }
  let nearest = distanceToLine(eyes, head, low);
  if (pose.leftHand) {
    transformPoint(placement, pose.leftHand.position, hand);
    nearest = Math.min(nearest, distance(eyes, hand));
  }
  if (pose.rightHand) {
    transformPoint(placement, pose.rightHand.position, hand);
    nearest = Math.min(nearest, distance(eyes, hand));
  }
  return smoothstep(goneAt, fadesFrom, nearest);
}
