import type { Pose } from '../math/pose';
import { fromAxisAngle, rotate, rotateInverse } from '../math/quat';
import { dot, forward, length, right, subtract, type Vec3, vec3 } from '../math/vec3';

/** The region in which a headset's cameras see a hand: a cone with its tip between the eyes. */
export interface CameraCone {
  /** The angle of the whole cone. */
  readonly degrees: number;
  /** The angle by which its axis is below the gaze. */
  readonly tiltDegrees: number;
  /** The smallest and the largest distance of a wrist [m]. */
  readonly nearest: number;
  readonly furthest: number;
}

/**
 * The view of a module for headsets: Stereo IR 170, at least 160° × 160°, from 10 cm to 75 cm
 * (ultraleap.com/company/news/blog/how-hand-tracking-works).
 */
export const headsetCameras: CameraCone = { degrees: 160, tiltDegrees: 0, nearest: 0.1, furthest: 0.75 };

const radians = Math.PI / 180;

/** The view of a headset's cameras, which contains the wrists that they see. */
export class CameraView {
  readonly #axis: Vec3;
  readonly #cosine: number;
  readonly #nearest: number;
  readonly #furthest: number;
  readonly #wrist = vec3(0, 0, 0);

  constructor({ degrees, tiltDegrees, nearest, furthest }: CameraCone) {
    this.#axis = rotate(fromAxisAngle(right, -tiltDegrees * radians), forward);
    this.#cosine = Math.cos((degrees / 2) * radians);
    this.#nearest = nearest;
    this.#furthest = furthest;
  }

  /** Returns whether a wrist is within the cone of a headset at this pose, floor frame. */
  sees(head: Pose<'floor'>, wrist: Vec3): boolean {
    const seen = this.#wrist;
    rotateInverse(head.orientation, subtract(wrist, head.position, seen), seen);
    const metres = length(seen);
    return metres >= this.#nearest && metres <= this.#furthest && dot(seen, this.#axis) >= this.#cosine * metres;
  }
}
