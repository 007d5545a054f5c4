import { estimatedJoints } from '../../body/joints';
import type { Pose } from '../../math/pose';
import { toEulerYxz } from '../../math/quat';
import { setVec3, type Vec3, vec3 } from '../../math/vec3';
import { type MutableJointPositions, makeJoints, transformJoints } from '../joint-positions';
import type { JointNetwork, JointSource, SolvedFrame } from '../joint-source';
import { LatestResult } from '../networks/latest-result';
import type { PoseRegressor } from '../networks/pose-regressor';

/** The number of features: two quantities of three components for three points. */
const paperFeatureCount = 18;

const angles = vec3(0, 0, 0);

function write(target: Float32Array, start: number, { x, y, z }: Vec3): void {
  target[start] = x;
  target[start + 3] = y;
  target[start + 6] = z;
}

function writePoint(target: Float32Array, column: number, { position, orientation }: Pose<'floor'>, head: Vec3): void {
  write(target, column, position);
  target[column] = position.x - head.x;
  target[column + 6] = position.z - head.z;
  write(target, 9 + column, toEulerYxz(orientation, angles));
}

/**
 * Writes the paper's input [1, 2, 3, 3]: depth (position [m] relative to the floor point under the headset, axes of the
 * room; Euler angles [rad]), row (x, y, z), column (head, left, right).
 */
export function paperFeatures(
  head: Pose<'floor'>,
  leftHand: Pose<'floor'>,
  rightHand: Pose<'floor'>,
  target: Float32Array = new Float32Array(paperFeatureCount),
): Float32Array {
  writePoint(target, 0, head, head.position);
  writePoint(target, 1, leftHand, head.position);
  writePoint(target, 2, rightHand, head.position);
  return target;
}

/**
 * Creates a source with the paper's network as published: positions in the room's axes and Euler angles in, six joints
 * out. Inverse kinematics supplies the joints before its first result.
 */
export function createPaper(regressor: PoseRegressor): JointSource {
  const input = new Float32Array(paperFeatureCount);
  const answered = makeJoints();
  let newest: Float32Array | null = null;
  const inference = new LatestResult(
    regressor,
    (output) => {
      newest = output;
    },
    () => {
      newest = null;
    },
  );

  /**
   * Writes the joints [m] of a result relative to the floor point under the current headset: a result for an older
   * frame moves with the head.
   */
  function place(output: Float32Array, { completed }: SolvedFrame, target: MutableJointPositions): void {
    const { x, z } = completed.head.position;
    for (let index = 0; index < estimatedJoints.length; index++) {
      const at = 3 * index;
      setVec3(target[estimatedJoints[index]!], x + output[at]!, output[at + 1]!, z + output[at + 2]!);
    }
  }

  const network: JointNetwork = {
    // Its joints are not filtered, so that each frame needs a result of its own.
    wantsFrames: true,
    ask({ completed }) {
      if (inference.running) return inference.running;
      return inference.start(paperFeatures(completed.head, completed.leftHand, completed.rightHand, input));
    },
    answer(solved) {
      if (newest === null) return null;
      place(newest, solved, answered);
      return answered;
    },
    get fault() {
      return inference.fault;
    },
  };

  return {
    network,
    calibrate: () => undefined,
    reset() {
      inference.reset();
      newest = null;
    },
    joints(solved, _, target) {
      if (newest) place(newest, solved, target);
      else transformJoints(solved.floorFromHeading, solved.ik.joints, target);
    },
  };
}
