import type { Calibration } from '../body/calibration';
import { type MutablePose, makePose, type TrackedPose } from '../math/pose';
import { fromAxisAngle, identity, type MutableQuat, multiply, quat, rotate } from '../math/quat';
import { addScaled, right, up, vec3 } from '../math/vec3';

const headUp = vec3(0, 0, 0);

/** Takes how a headset sits on its wearer's head out of its pose: the pitch that a calibration measured, and how far it sits above its usual place. */
export class HeadsetMountCorrection {
  readonly #corrected: MutablePose<'floor'> & { tracking: TrackedPose['tracking'] } = {
    ...makePose<'floor'>(),
    tracking: 'tracked',
  };
  /** From the headset to the head as its wearer holds it; null: level, or not measured. */
  #levelling: MutableQuat | null = null;

  constructor(calibration: Calibration) {
    this.calibrate(calibration);
  }

  calibrate({ gazePitch = 0 }: Calibration): void {
    this.#levelling = gazePitch === 0 ? null : fromAxisAngle(right, -gazePitch, quat(0, 0, 0, 1));
  }

  /** The head as its wearer holds it, lower by `rise` [m] along its own up, floor frame; overwritten by the next call. */
  apply(tracked: TrackedPose, rise: number): TrackedPose {
    if (this.#levelling === null && rise === 0) return tracked;
    const { position, orientation } = this.#corrected;
    multiply(tracked.orientation, this.#levelling ?? identity, orientation);
    addScaled(tracked.position, rotate(orientation, up, headUp), -rise, position);
    this.#corrected.tracking = tracked.tracking;
    return this.#corrected;
  }
}
