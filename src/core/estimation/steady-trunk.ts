import { smoothstep } from '../math/damper';
import type { Pose } from '../math/pose';
import { rotate } from '../math/quat';
import { add, addScaled, length, normalise, right, subtract, type Vec3 } from '../math/vec3';
import type { JointPositions } from './joint-positions';

/** The trunk's joints [m]. */
export type TrunkJoints = Pick<JointPositions, 'leftUpperArm' | 'rightUpperArm' | 'chest' | 'hips'>;

/** Estimated hips, chest and shoulders move about the head at most this fast [m/s]; 999 of 1000 frames of the motion trained on are slower. */
const trunkJointSpeed = 2.5;
/** The same where the head lies on its side, so that its heading says nothing of the body's. */
const vagueTrunkSpeed = 0.6;
/** The horizontal part of the head's right axis at which its heading begins to say something, and says all. */
const [vagueHead, sureHead] = [0.35, 0.7];

/**
 * The trunk's joints about the head joint, floor axes, as estimated in the floor frame, but no further from those of the frame before
 * (null: there was none) than a body moves: a head on its side changes its heading at once.
 */
export function steadyTrunk(
  estimated: TrunkJoints,
  head: Pose<'floor'>,
  headJoint: Vec3,
  before: TrunkJoints | null,
  deltaSeconds: number,
): TrunkJoints {
  const side = rotate(head.orientation, right);
  const defined = smoothstep(vagueHead, sureHead, Math.hypot(side.x, side.z));
  const most = (vagueTrunkSpeed + (trunkJointSpeed - vagueTrunkSpeed) * defined) * Math.max(deltaSeconds, 0);
  return eachTrunkJoint((joint) => {
    const now = subtract(estimated[joint], headJoint);
    if (!before) return now;
    const way = subtract(now, before[joint]);
    return length(way) <= most ? now : addScaled(before[joint], normalise(way), most);
  });
}

/** From about the head joint to the floor frame. */
export const trunkUnder = (headJoint: Vec3, about: TrunkJoints): TrunkJoints =>
  eachTrunkJoint((joint) => add(headJoint, about[joint]));

const eachTrunkJoint = (place: (joint: keyof TrunkJoints) => Vec3): TrunkJoints => ({
  leftUpperArm: place('leftUpperArm'),
  rightUpperArm: place('rightUpperArm'),
  chest: place('chest'),
  hips: place('hips'),
});
