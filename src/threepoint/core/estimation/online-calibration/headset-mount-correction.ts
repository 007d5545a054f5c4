import type { Calibration } from '../../body/calibration';
import { makeTrackedPose, type TrackedPose } from '../../math/pose';
import { fromAxisAngle, identity, type MutableQuat, multiply, quat, rotate } from '../../math/quat';
import { addScaled, right, up, vec3 } from '../../math/vec3';

const headUp = vec3(0, 0, 0);

/**
 * Corrects a head pose for the mount of the headset: the pitch that a calibration measured, and the rise above its
 * nominal position.
 */
export class HeadsetMountCorrection {
  readonly #corrected = makeTrackedPose();
  /** The rotation from the headset to a level head; null: level, or not measured. */
  #levelling: MutableQuat | null = null;

  constructor(calibration: Calibration) {
    this.calibrate(calibration);
  }

  calibrate({ gazePitch = 0 }: Calibration): void {
    this.#levelling = gazePitch === 0 ? null : fromAxisAngle(right, -gazePitch, quat(0, 0, 0, 1));
  }

  /**
   * Returns the corrected head pose, floor frame: levelled, and lowered by `rise` [m] along its own up axis.
   * Overwritten by the next call.
   */
  apply(tracked: TrackedPose, rise: number): TrackedPose {
    if (this.#levelling === null && rise === 0) return tracked;
    const { position, orientation } = this.#corrected;
    multiply(tracked.orientation, this.#levelling ?? identity, orientation);
    addScaled(tracked.position, rotate(orientation, up, headUp), -rise, position);
    this.#corrected.tracking = tracked.tracking;
    return this.#corrected;
  }
}
