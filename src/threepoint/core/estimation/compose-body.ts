import type { MutableUpperBodyPose } from '../body/avatar-pose';
import { writeLocalRotations } from '../body/local-rotations';
import type { Quat } from '../math/quat';
import { copyVec3 } from '../math/vec3';
import type { FitArmsState } from './arms/fit-arms';
import type { TorsoPose } from './trunk/fit-torso';

/** Writes the body of one frame, from its trunk, arms and head in the floor frame. */
export function composeBody(torso: TorsoPose, arms: FitArmsState, head: Quat, body: MutableUpperBodyPose): void {
  copyVec3(torso.hips, body.hipsPosition);
  writeLocalRotations(torso.rotations, head, torso.clavicles, arms, body.localRotations);
}
