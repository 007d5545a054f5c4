import { estimatedJoints } from '../../body/joints';
import {
  invertTransform,
  makePose,
  makeTransform,
  type Pose,
  type Transform,
  transformPoint,
  transformPose,
} from '../../math/pose';
import { toEulerYxz } from '../../math/quat';
import { setVec3, type Vec3, vec3 } from '../../math/vec3';
import { type MutableJointPositions, makeJoints, transformJoints } from '../joint-positions';
import type { JointNetwork, JointSource, SolvedFrame } from '../joint-source';
import { LatestResult } from '../networks/latest-result';
import type { PoseRegressor } from '../networks/pose-regressor';

/** The number of features: two quantities of three components for three points. */
const paperFeatureCount = 18;

const headingFromFloor = makeTransform<'heading', 'floor'>();
const inHeading = makePose<'heading'>();
const angles = vec3(0, 0, 0);

function write(target: Float32Array, start: number, { x, y, z }: Vec3): void {
  target[start] = x;
  target[start + 3] = y;
  target[start + 6] = z;
}

function writePoint(target: Float32Array, column: number, point: Pose<'floor'>): void {
  transformPose(headingFromFloor, point, inHeading);
  write(target, column, inHeading.position);
  write(target, 9 + column, toEulerYxz(inHeading.orientation, angles));
}

/**
 * Writes the paper's input [1, 2, 3, 3], heading frame: depth (position [m]; Euler angles [rad]), row (x, y, z), column
 * (head, left, right).
 */
export function paperFeatures(
  head: Pose<'floor'>,
  leftHand: Pose<'floor'>,
  rightHand: Pose<'floor'>,
  floorFromHeading: Transform<'floor', 'heading'>,
  target: Float32Array = new Float32Array(paperFeatureCount),
): Float32Array {
  invertTransform(floorFromHeading, headingFromFloor);
  writePoint(target, 0, head);
  writePoint(target, 1, leftHand);
  writePoint(target, 2, rightHand);
  return target;
}

/**
 * Creates a source with the paper's network: positions and Euler angles in, six joints out, in axes that turn with the
 * head. Inverse kinematics supplies the joints before its first result.
 */
export function createPaper(regressor: PoseRegressor): JointSource {
  const input = new Float32Array(paperFeatureCount);
  const answered = makeJoints();
  const inference = new LatestResult(regressor);

  /** Writes the joints [m] of a result, floor frame: a result for an older frame moves and turns with the head. */
  function place(output: Float32Array, solved: SolvedFrame, target: MutableJointPositions): void {
    for (let index = 0; index < estimatedJoints.length; index++) {
      const joint = target[estimatedJoints[index]!];
      setVec3(joint, output[3 * index]!, output[3 * index + 1]!, output[3 * index + 2]!);
      transformPoint(solved.floorFromHeading, joint, joint);
    }
  }

  const network: JointNetwork = {
    // Its joints are not filtered, so that each frame needs a result of its own.
    wantsFrames: true,
    ask({ trackers: { head, leftHand, rightHand }, floorFromHeading }) {
      if (inference.running) return inference.running;
      return inference.start(paperFeatures(head.value, leftHand.value, rightHand.value, floorFromHeading, input));
    },
    answer(solved) {
      if (inference.output === null) return null;
      place(inference.output, solved, answered);
      return answered;
    },
    get fault() {
      return inference.fault;
    },
  };

  return {
    network,
    calibrate: () => undefined,
    reset: () => inference.reset(),
    joints(solved, _, target) {
      if (inference.output) place(inference.output, solved, target);
      else transformJoints(solved.floorFromHeading, solved.ik.joints, target);
    },
  };
}
