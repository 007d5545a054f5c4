import { copyPose, type Pose, type TrackedPose } from '../math/pose';
import { copyQuat, type MutableQuat, type Quat, quat } from '../math/quat';
import { copyVec3, type MutableVec3, type Vec3, vec3 } from '../math/vec3';
import { recordOf } from '../records';
import { copyFingers, type Fingers } from './hand-shape';
import { type JointName, jointNames } from './joints';

/**
 * Rotations of the upper body's joints; every identity is the T-pose facing −Z. `hips` is relative to the floor frame.
 */
export interface UpperBodyPose {
  readonly hipsPosition: Vec3;
  readonly localRotations: Readonly<Record<JointName, Quat>>;
}

/** A body's pose that its owner overwrites; a buffer. */
export interface MutableUpperBodyPose extends UpperBodyPose {
  readonly hipsPosition: MutableVec3;
  readonly localRotations: Readonly<Record<JointName, MutableQuat>>;
}

export const makeUpperBodyPose = (): MutableUpperBodyPose => ({
  hipsPosition: vec3(0, 0, 0),
  localRotations: recordOf(jointNames, () => quat(0, 0, 0, 1)),
});

/** The ankles that trackers pin, floor frame: at rest the toes point along −Z; null: the gait is estimated. */
export interface TrackedFeet {
  readonly left: Pose<'floor'> | null;
  readonly right: Pose<'floor'> | null;
}

/**
 * The pose of one frame: hands as tracked, the head as tracked and corrected for the headset's mount, and the body
 * between them. `body` is null for estimators without a body (hands-only). Plain data that can be serialised as JSON.
 */
export interface AvatarPose {
  readonly head: TrackedPose;
  readonly leftHand: TrackedPose | null;
  readonly rightHand: TrackedPose | null;
  readonly body: UpperBodyPose | null;
  /**
   * The bends of each hand's fingers [rad], wrist's frame, as tracked in this frame or inferred from a controller's
   * buttons; a hand is null while its fingers are unknown. Absent: the source of the pose has no fingers.
   */
  readonly fingers?: Fingers | undefined;
  /** Absent: no foot is tracked. */
  readonly feet?: TrackedFeet | undefined;
}

const copyTracked = <T extends TrackedPose | null>(pose: T): T =>
  pose && { ...pose, position: copyVec3(pose.position), orientation: copyQuat(pose.orientation) };

/**
 * Returns a copy of the pose that can be kept: estimators and playback overwrite theirs with every frame.
 *
 * @example
 * if (tracker.pose) history.push(copyAvatarPose(tracker.pose));
 */
export const copyAvatarPose = ({ head, leftHand, rightHand, body, fingers, feet }: AvatarPose): AvatarPose => ({
  head: copyTracked(head),
  leftHand: copyTracked(leftHand),
  rightHand: copyTracked(rightHand),
  body: body && {
    hipsPosition: copyVec3(body.hipsPosition),
    localRotations: recordOf(jointNames, (joint) => copyQuat(body.localRotations[joint])),
  },
  ...(fingers && { fingers: copyFingers(fingers) }),
  ...(feet && { feet: { left: feet.left && copyPose(feet.left), right: feet.right && copyPose(feet.right) } }),
});
