// A program of Node that draws a body and makes a file of its motion, by the network whose weights the package brings,
// and checks a file of an avatar as a server of avatars would.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { Body, forwardKinematics, skeletonFromCalibration } from 'threepoint';
import { exportMotion } from 'threepoint/motion';
import { loadAvatar } from 'threepoint/three';

const calibration = { eyeHeight: 1.6, armSpan: 1.51 };
const at = (x, y, z) => ({ position: { x, y, z }, orientation: { x: 0, y: 0, z: 0, w: 1 }, tracking: 'tracked' });
/** A second of a person who lifts the right hand, 60 frames of it: floor frame [m, s]. */
const frames = Array.from({ length: 60 }, (_, i) => ({
  time: i / 60,
  head: at(0, 1.6, 0),
  leftHand: at(-0.25, 0.8, -0.1),
  rightHand: at(0.25, 0.8 + 0.01 * i, -0.25),
}));

const body = new Body({ calibration });
await body.setEstimator('learned');
if (body.estimator !== 'learned') throw new Error(body.unavailableEstimators.learned);
for (const frame of frames) body.update(frame);
const joints = forwardKinematics(skeletonFromCalibration(calibration), body.pose.body);
console.log(`The elbow is ${joints.rightLowerArm.position.y.toFixed(2)} m above the floor.`);

const { parts } = await exportMotion({ device: 'none', rateHz: 60, calibration, frames }, { format: 'bvh' });
console.log(`Its motion as BVH is ${parts.join('').length} characters long.`);

const file = fileURLToPath(import.meta.resolve('threepoint/avatars/mannequin.vrm'));
await loadAvatar(readFileSync(file), { untrusted: true });
await loadAvatar(readFileSync(file).subarray(0, 50_000), { untrusted: true }).then(
  () => {
    throw new Error('A file that was cut off was taken.');
  },
  ({ message }) => console.log(`A file that was cut off is refused: ${message}`),
);
