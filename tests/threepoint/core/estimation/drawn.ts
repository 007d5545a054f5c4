import { type AvatarPose, copyAvatarPose, makeUpperBodyPose } from '../../../../src/threepoint/core/body/avatar-pose';
import type { Calibration } from '../../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import { headJointOf } from '../../../../src/threepoint/core/body/head-joint';
import type { JointName } from '../../../../src/threepoint/core/body/joints';
import { writeLocalRotations } from '../../../../src/threepoint/core/body/local-rotations';
import { averageSkeleton } from '../../../../src/threepoint/core/body/skeleton';
import { armBones, fitArms, makeFitArmsState } from '../../../../src/threepoint/core/estimation/arms/fit-arms';
import type { CompletedFrame, CompletedHand } from '../../../../src/threepoint/core/estimation/complete-hands';
import type { JointPositions } from '../../../../src/threepoint/core/estimation/joint-positions';
import type { PoseEstimator } from '../../../../src/threepoint/core/estimation/pose-estimator';
import { fitTorso, makeFitTorsoState } from '../../../../src/threepoint/core/estimation/trunk/fit-torso';
import { torsoBones } from '../../../../src/threepoint/core/estimation/trunk/torso-bones';
import type { Pose } from '../../../../src/threepoint/core/math/pose';
import { copyQuat, identity } from '../../../../src/threepoint/core/math/quat';
import { copyVec3, normalise, vec3 } from '../../../../src/threepoint/core/math/vec3';
import { readHeading } from '../../../../src/threepoint/core/tracking/heading';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';

/** Every joint of a body, floor frame. */
export type Joints = Readonly<Record<JointName, Pose<'floor'>>>;

/** What the estimator draws of this frame, to be kept; no network is asked. */
export const poseOf = (estimator: PoseEstimator, frame: TrackingFrame): AvatarPose =>
  copyAvatarPose(estimator.update(frame).pose);

/** One frame as on the page: drawn, then asked about; the answer counts from the next frame on. */
export async function show(estimator: PoseEstimator, frame: TrackingFrame): Promise<AvatarPose> {
  const { pose, request } = estimator.update(frame);
  const drawn = copyAvatarPose(pose);
  await request?.ask();
  return drawn;
}

/** Frame after frame, each asked about; what is drawn of the last. */
export async function showAll(estimator: PoseEstimator, frames: readonly TrackingFrame[]): Promise<AvatarPose> {
  let pose: AvatarPose | null = null;
  for (const frame of frames) pose = await show(estimator, frame);
  if (pose === null) throw new Error('no frame was shown');
  return pose;
}

const seenHand = ({ position, orientation }: Pose<'floor'>): CompletedHand => ({
  position: copyVec3(position),
  orientation: copyQuat(orientation),
  source: 'tracked',
  confidence: 1,
  goal: { position: copyVec3(position), orientation: copyQuat(orientation) },
  jumped: false,
});

/** A frame in which both hands are seen. */
export const completedFrame = (
  { head, leftHand, rightHand }: Readonly<Record<'head' | 'leftHand' | 'rightHand', Pose<'floor'>>>,
  calibration: Calibration,
): CompletedFrame => ({
  head,
  headJoint: headJointOf(head, averageSkeleton(calibration).eyesInHead, vec3(0, 0, 0)),
  heading: readHeading(head.orientation),
  bodyTurn: identity,
  leftHand: seenHand(leftHand),
  rightHand: seenHand(rightHand),
});

/** IK's elbows of arms whose estimate says nothing: down and outward. */
const poles = { left: normalise(vec3(-0.2, -1, 0.5)), right: normalise(vec3(0.2, -1, 0.5)) };

/** The last stage with its memory: fits one body to estimated joints, frame after frame; where its joints are then. */
export function fitted(
  calibration: Calibration,
): (frame: CompletedFrame, joints: JointPositions, deltaSeconds: number) => Joints {
  const skeleton = averageSkeleton(calibration);
  const bones = { torso: torsoBones(skeleton), arm: armBones(skeleton) };
  const state = { torso: makeFitTorsoState(), arms: makeFitArmsState() };
  const body = makeUpperBodyPose();
  return (frame, joints, deltaSeconds) => {
    const torso = fitTorso(state.torso, joints, frame, bones.torso, deltaSeconds);
    const arms = fitArms(state.arms, { frame, joints, torso, bones: bones.arm, poles }, deltaSeconds);
    copyVec3(torso.hips, body.hipsPosition);
    writeLocalRotations(torso.rotations, frame.head.orientation, torso.clavicles, arms, body.localRotations);
    return forwardKinematics(skeleton, body);
  };
}
