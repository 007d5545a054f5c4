import type { Quat } from '../math/quat';
import type { Vec3 } from '../math/vec3';
import type { TrackedPose } from '../tracking/tracking-frame';
import type { JointName } from './joints';

/** Rotations of the upper body's joints; every identity is the T-pose facing −Z. `hips` is relative to the floor frame. */
export interface UpperBodyPose {
  readonly hipsPosition: Vec3;
  readonly localRotations: Readonly<Record<JointName, Quat>>;
}

/**
 * What one frame shows: head and hands exactly as tracked in this frame, and the body between them.
 * `body` is null for estimators that show no body (hands-only).
 */
export interface AvatarPose {
  readonly head: TrackedPose;
  readonly leftHand: TrackedPose | null;
  readonly rightHand: TrackedPose | null;
  readonly body: UpperBodyPose | null;
}
