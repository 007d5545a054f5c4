import type { Pose } from '../math/pose';
import { rotateInverse } from '../math/quat';
import { dot, forward, length, subtract, type Vec3, vec3 } from '../math/vec3';

/**
 * The view of a module for headsets: a cone about the gaze with its tip between the eyes. Stereo IR 170 sees at least
 * 160° × 160°, from 10 cm to 75 cm (ultraleap.com/company/news/blog/how-hand-tracking-works).
 */
const cosine = Math.cos((80 * Math.PI) / 180);
const nearest = 0.1;
const furthest = 0.75;

const fromEyes = vec3(0, 0, 0);

/** Returns whether the cameras of a headset at this pose see a wrist, floor frame. */
export function camerasSee(head: Pose<'floor'>, wrist: Vec3): boolean {
  rotateInverse(head.orientation, subtract(wrist, head.position, fromEyes), fromEyes);
  const metres = length(fromEyes);
  return metres >= nearest && metres <= furthest && dot(fromEyes, forward) >= cosine * metres;
}
