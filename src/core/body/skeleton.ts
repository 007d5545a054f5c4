import type { Vec3 } from '../math/vec3';
import type { JointName } from './joints';

/**
 * The calibrated body in T-pose, facing −Z: each joint's offset [m] from its parent (`hips`: from the floor below),
 * and where the headset's origin sits in the frame of the head joint.
 */
export interface Skeleton {
  readonly restOffsets: Readonly<Record<JointName, Vec3>>;
  readonly eyesInHead: Vec3;
}
