import type { Calibration } from '../../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import type { JointName } from '../../../../src/threepoint/core/body/joints';
import { skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import { createEstimator } from '../../../../src/threepoint/core/estimation/estimators';
import type { Side } from '../../../../src/threepoint/core/math/side';
import { dot, lerp, normalise, subtract, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { type Joints, poseOf } from './drawn';

export const calibration: Calibration = { eyeHeight: 1.62, armSpan: 1.53 };
export const degrees = Math.PI / 180;

/** The body that IK gives a person who has held this pose for a while. */
export function bodyOf(frame: TrackingFrame, body = calibration): Joints {
  const estimator = createEstimator('ik', body);
  let joints: Joints | null = null;
  for (let i = 0; i < 5; i++) {
    const pose = poseOf(estimator, { ...frame, time: frame.time + i / 60 });
    joints = forwardKinematics(skeletonFromCalibration(body), pose.body!);
  }
  return joints!;
}

export const at = (joints: Joints, joint: JointName): Vec3 => joints[joint].position;

/** The angle [rad] at the elbow between the two bones. */
export const bentBy = (joints: Joints, side: Side): number => {
  const upper = normalise(subtract(at(joints, `${side}LowerArm`), at(joints, `${side}UpperArm`)));
  const lower = normalise(subtract(at(joints, `${side}Hand`), at(joints, `${side}LowerArm`)));
  return Math.acos(Math.max(-1, Math.min(1, dot(upper, lower))));
};

export const hip = { left: vec3(-0.22, 0.85, -0.05), right: vec3(0.22, 0.85, -0.05) };
export const ahead = { left: vec3(-0.2, 1.25, -0.4), right: vec3(0.2, 1.25, -0.4) };

/** Returns the elbow relative to the middle of the straight line from shoulder to wrist. */
export const elbowAside = (joints: Joints, side: Side): Vec3 =>
  subtract(at(joints, `${side}LowerArm`), lerp(at(joints, `${side}UpperArm`), at(joints, `${side}Hand`), 0.5));
