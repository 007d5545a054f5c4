import {
  type AvatarPose,
  type Calibration,
  createJointPoses,
  deviceJoint,
  type EstimatedJoint,
  estimatedJoints,
  forwardKinematics,
  type Skeleton,
  skeletonFromCalibration,
  type TrackingFrame,
} from 'threepoint/core';
import { distance, smoothingFactor, vec3 } from 'threepoint/math';

/** Half-life of the mean [s]: long enough to read. */
const halfLife = 0.5;

/** What the joints are called on the page. */
export const jointLabels: Readonly<Record<EstimatedJoint, string>> = {
  leftLowerArm: 'left elbow',
  rightLowerArm: 'right elbow',
  leftUpperArm: 'left shoulder',
  rightUpperArm: 'right shoulder',
  chest: 'spine',
  hips: 'pelvis',
};

const place = vec3(0, 0, 0);

/** The distance of the drawn joints from the device's: a mean over the last moments, or as `shareOf` says. */
export class DeviceDifference {
  readonly #shareOf: (elapsed: number) => number;
  readonly #joints = createJointPoses();
  /** [m], in the order of `estimatedJoints`. */
  readonly #means = new Float64Array(estimatedJoints.length);
  #skeleton: Skeleton | null = null;
  #skeletonOf: Calibration | null = null;
  #time = Number.NaN;

  /** `shareOf`: the share of a frame in the mean, so long after the frame before [s]. */
  constructor(shareOf = (elapsed: number) => smoothingFactor(halfLife, elapsed)) {
    this.#shareOf = shareOf;
  }

  /** Called with every drawn frame. A frame without a body of the device is ignored. */
  observe({ time, deviceBody }: TrackingFrame, { body }: AvatarPose, calibration: Calibration): void {
    if (!deviceBody || !body) {
      this.#time = Number.NaN;
      return;
    }
    if (this.#skeletonOf !== calibration) this.#skeleton = skeletonFromCalibration(calibration);
    this.#skeletonOf = calibration;
    forwardKinematics(this.#skeleton!, body, this.#joints);
    const share = Number.isNaN(this.#time) ? 1 : this.#shareOf(Math.max(0, time - this.#time));
    this.#time = time;
    for (let index = 0; index < estimatedJoints.length; index++) {
      const joint = estimatedJoints[index]!;
      const off = distance(this.#joints[joint].position, deviceJoint(deviceBody, joint, place));
      this.#means[index] = this.#means[index]! + share * (off - this.#means[index]!);
    }
  }

  /** By joint [cm]; null: the device reports no body now. */
  report(): readonly { readonly name: string; readonly cm: number }[] | null {
    if (Number.isNaN(this.#time)) return null;
    return estimatedJoints.map((joint, index) => ({ name: jointLabels[joint], cm: 100 * this.#means[index]! }));
  }
}
