import { estimatedJoints } from '../../body/joints';
import { setVec3 } from '../../math/vec3';
import { type MutableJointPositions, makeJoints, transformJoints } from '../joint-positions';
import type { JointNetwork, JointSource, SolvedFrame } from '../joint-source';
import { LatestResult } from '../networks/latest-result';
import { paperFeatureCount, paperFeatures } from '../networks/paper-features';
import type { PoseRegressor } from '../networks/pose-regressor';

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
