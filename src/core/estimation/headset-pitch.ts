import type { Calibration } from '../body/calibration';
import { type MutablePose, makePose, type TrackedPose } from '../math/pose';
import { fromAxisAngle, type MutableQuat, multiply, quat } from '../math/quat';
import { copyVec3, right } from '../math/vec3';

/** Takes the pitch of a headset that sits tilted on its wearer's head out of its pose. */
export class HeadsetPitch {
  readonly #levelled: MutablePose<'floor'> & { tracking: TrackedPose['tracking'] } = {
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

  /** The head as its wearer holds it, floor frame; overwritten by the next call. */
  level(head: TrackedPose): TrackedPose {
    if (this.#levelling === null) return head;
    copyVec3(head.position, this.#levelled.position);
    multiply(head.orientation, this.#levelling, this.#levelled.orientation);
    this.#levelled.tracking = head.tracking;
    return this.#levelled;
  }
}
