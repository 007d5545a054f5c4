import { type EstimatedJoint, estimatedJoints } from '../../body/joints';
import { rotate, rotateInverse } from '../../math/quat';
import { addScaled, distance, subtract, type Vec3, vec3 } from '../../math/vec3';
import { type DeviceBody, deviceJoint, type SharedJoint } from '../../tracking/device-body';
import { makeJoints, mapJoints } from '../joint-positions';
import type { JointSource, SolvedFrame } from '../joint-source';

/**
 * The largest distance [m] of the device's head or wrist from the tracked one; beyond it the device reports another
 * body or moment.
 */
const strayHead = 0.3;
const strayWrist = 0.2;
/** The time [s] of the transition between the device's joints and the other source's. */
const handOverSeconds = 0.3;

const armOf: Partial<Record<EstimatedJoint, 'leftHand' | 'rightHand'>> = {
  leftLowerArm: 'leftHand',
  rightLowerArm: 'rightHand',
};

const place = vec3(0, 0, 0);

const isNear = (body: DeviceBody, joint: SharedJoint, tracked: Vec3, most: number): boolean =>
  distance(deviceJoint(body, joint, place), tracked) <= most;

/**
 * Creates a source with the joints of the device's own body. If the device reports none, or an elbow or body that does
 * not match head and hands, `otherwise` supplies that elbow or all joints; the difference is blended within 0.3 s.
 */
export function createDeviceSource(otherwise: JointSource): JointSource {
  /** The offset of the device's joints from the other source's [m], heading frame, and its weight [0, 1]. */
  const differences = makeJoints();
  const fractions = mapJoints(() => 0);
  let known = false;

  function isPlausible(joint: EstimatedJoint, { deviceBody, completed }: SolvedFrame): boolean {
    if (!deviceBody || !isNear(deviceBody, 'head', completed.headJoint, strayHead)) return false;
    const hand = armOf[joint];
    return hand === undefined || isNear(deviceBody, hand, completed[hand].position, strayWrist);
  }

  return {
    network: otherwise.network,
    calibrate: (body) => otherwise.calibrate(body),
    reset() {
      otherwise.reset();
      known = false;
    },
    joints(solved, deltaSeconds, target) {
      otherwise.joints(solved, deltaSeconds, target);
      const { orientation } = solved.floorFromHeading;
      const step = known ? deltaSeconds / handOverSeconds : 1;
      known = true;
      for (let index = 0; index < estimatedJoints.length; index++) {
        const joint = estimatedJoints[index]!;
        const difference = differences[joint];
        const sees = isPlausible(joint, solved);
        if (sees && solved.deviceBody) {
          subtract(deviceJoint(solved.deviceBody, joint, place), target[joint], place);
          rotateInverse(orientation, place, difference);
        }
        fractions[joint] = sees ? Math.min(1, fractions[joint] + step) : Math.max(0, fractions[joint] - step);
        addScaled(target[joint], rotate(orientation, difference, place), fractions[joint], target[joint]);
      }
    },
  };
}
