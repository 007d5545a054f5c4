import { readFileSync } from 'node:fs';
import type { LegProportions } from '../../src/avatar/legs/leg-posture';
import { legProportionsOf } from '../../src/avatar/legs/legs';
import { parseAvatar } from '../../src/avatar/load-avatar';
import { Rig } from '../../src/avatar/rig/rig';
import type { Calibration } from '../../src/core/body/calibration';
import { forwardKinematics } from '../../src/core/body/forward-kinematics';
import { jointNames } from '../../src/core/body/joints';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import { identity, type Quat } from '../../src/core/math/quat';

const mannequin = new URL('../../public/avatars/mannequin.vrm', import.meta.url);

/** The legs that the page's mannequin has on a calibrated body. */
export async function mannequinLegs(): Promise<(calibration: Calibration) => LegProportions> {
  const { buffer, byteOffset, byteLength } = readFileSync(mannequin);
  const bytes = buffer.slice(byteOffset, byteOffset + byteLength) as ArrayBuffer;
  const { vrm } = await parseAvatar(bytes, 'mannequin.vrm');
  vrm.scene.updateMatrixWorld(true);
  const rig = new Rig(vrm);
  const upright = Object.fromEntries(jointNames.map((name) => [name, identity])) as Record<string, Quat>;
  return (calibration) => {
    const skeleton = skeletonFromCalibration(calibration);
    const { hips, head } = forwardKinematics(skeleton, {
      hipsPosition: skeleton.restOffsets.hips,
      localRotations: upright as Record<(typeof jointNames)[number], Quat>,
    });
    return legProportionsOf(rig, hips.position.y, head.position.y / (rig.rest('head')?.y ?? 1));
  };
}
