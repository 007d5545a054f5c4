import { readFileSync } from 'node:fs';
import type { LegProportions } from 'threepoint/avatar/legs/leg-posture';
import { legProportionsOf } from 'threepoint/avatar/legs/legs';
import { parseAvatar } from 'threepoint/avatar/load-avatar';
import { Rig } from 'threepoint/avatar/rig/rig';
import type { Calibration } from 'threepoint/core/body/calibration';
import { forwardKinematics } from 'threepoint/core/body/forward-kinematics';
import { jointNames } from 'threepoint/core/body/joints';
import { skeletonFromCalibration } from 'threepoint/core/body/skeleton';
import { identity } from 'threepoint/core/math/quat';
import { recordOf } from 'threepoint/core/records';

const mannequin = new URL('../../public/avatars/mannequin.vrm', import.meta.url);

/** The legs that the page's mannequin has on a calibrated body. */
export async function mannequinLegs(): Promise<(calibration: Calibration) => LegProportions> {
  const { buffer, byteOffset, byteLength } = readFileSync(mannequin);
  const bytes = buffer.slice(byteOffset, byteOffset + byteLength) as ArrayBuffer;
  const { vrm } = await parseAvatar(bytes, 'mannequin.vrm');
  vrm.scene.updateMatrixWorld(true);
  const rig = new Rig(vrm);
  const upright = recordOf(jointNames, () => identity);
  return (calibration) => {
    const skeleton = skeletonFromCalibration(calibration);
    const { hips, head } = forwardKinematics(skeleton, {
      hipsPosition: skeleton.restOffsets.hips,
      localRotations: upright,
    });
    return legProportionsOf(rig, hips.position.y, head.position.y / (rig.rest('head')?.y ?? 1));
  };
}
