// Every entry of the package, compiled against its source by `npm run types` and as packed by `npm run test:full`.
import { createElement, type RefObject } from 'react';
import type { Scene, WebGLRenderer } from 'three';
import type { WebGPURenderer } from 'three/webgpu';
import {
  type AvatarPose,
  Body,
  type BodyEvent,
  type BodyTrackers,
  type Calibration,
  copyAvatarPose,
  defaultCalibration,
  forwardKinematics,
  type GuidedCalibration,
  initialGuidedCalibration,
  loadLearned,
  type PoseRegressor,
  parseRecording,
  skeletonFromCalibration,
  stepGuidedCalibration,
  type TrackingFrame,
} from 'threepoint';
import { exportMotion, toXRBody, type XRBodyJoints } from 'threepoint/motion';
import { type OnnxNetworksOptions, onnxNetworks } from 'threepoint/onnx';
import 'threepoint/onnx-worker';
import { type EmulatedBody, installBodyTracking } from 'threepoint/polyfill';
import { RemoteAvatar, SelfAvatar } from 'threepoint/react';
import { type Avatar, avatarMotionWriter, BodyTracker, loadAvatar } from 'threepoint/three';
import { pinning, trackerAtJoint } from 'threepoint/trackers';

/** With three.js, its session and an avatar. */
export async function inTheHeadset(renderer: WebGLRenderer | WebGPURenderer, scene: Scene): Promise<BodyTracker> {
  const avatar: Avatar = await loadAvatar('/avatars/me.glb', { bones: { hips: 'Hips', head: 'Head' } });
  const body = new BodyTracker(renderer, { avatar, estimator: 'learned', calibration: 'auto', autoGrow: false });
  body.addEventListener('calibrated', ({ calibration, source }) => console.log(calibration.eyeHeight, source));
  body.addEventListener('fallback', ({ estimator, reason }: BodyEvent<'fallback'>) => console.log(estimator, reason));
  body.addEventListener('trackinglost', ({ point }) => console.log(point));
  body.addEventListener('sessionend', () => console.log(body.pose));
  scene.add(body.object);
  renderer.setAnimationLoop((timeMs, frame) => {
    body.update(timeMs, frame);
    const elbow: number | undefined = body.avatar.jointPositions().leftLowerArm?.y;
    console.log(elbow, body.body.provider);
  });
  return body;
}

/** In react-three-fiber: the user's body, and one by the poses that another page sends. */
export const inReact = (send: (pose: AvatarPose | null) => void, received: RefObject<AvatarPose | null>) => [
  createElement(SelfAvatar, {
    avatar: '/avatars/me.vrm',
    estimator: 'ik',
    onPose: send,
    onSessionEnd: () => send(null),
    onTrackingLost: ({ point }) => console.log(point),
  }),
  createElement(RemoteAvatar, { avatar: '/avatars/them.vrm', pose: received, calibration: defaultCalibration }),
];

/** Without three.js, by the runtime. */
export function withoutThree(
  options: OnnxNetworksOptions,
  frame: TrackingFrame,
  person: Calibration,
): number | undefined {
  const body = new Body({ estimator: 'paper', networks: onnxNetworks(options) });
  body.addEventListener('discontinuity', () => console.log('moved'));
  body.addEventListener('heightmismatch', ({ difference }) => console.log(difference));
  const pose: AvatarPose | null = body.update(frame, person);
  console.log(pose?.fingers?.left?.index.knuckle, pose && copyAvatarPose(pose));
  // @ts-expect-error the methods of the paper need the networks of threepoint/onnx
  void new Body().setEstimator('paper');
  return pose?.body
    ? forwardKinematics(skeletonFromCalibration(body.calibration), pose.body).head.position.y
    : undefined;
}

/** The default: the learned network without a runtime, or another one that the page has. */
export async function byDefault(): Promise<Body> {
  const network: PoseRegressor = await loadLearned({ onProgress: (fraction) => console.log(fraction) });
  const body = new Body({ networks: async () => network });
  await body.dispose();
  return body;
}

/** A recording as files for other programs, and a pose as WebXR has bodies. */
export async function forOthers(text: string, signal: AbortSignal): Promise<Blob[]> {
  const recording = parseRecording(text);
  const onProgress = ({ fraction, secondsLeft }: { fraction: number; secondsLeft: number | null }) =>
    console.log(fraction, secondsLeft);
  const bvh = await exportMotion(recording, { format: 'bvh', unit: 'cm', rateHz: 30, signal, onProgress });
  const glb = await exportMotion(recording, { format: await avatarMotionWriter('/avatars/me.vrm'), estimator: 'ik' });
  return [bvh, glb].map(({ parts, type }) => new Blob([...parts], { type }));
}

export function asWebXR({ body }: AvatarPose, calibration: Calibration): number | undefined {
  const joints: XRBodyJoints | null = body && toXRBody(body, calibration);
  return joints?.get('left-arm-lower')?.position.y;
}

/** With trackers on belt and shoe, whose mounts a guided calibration has measured; the shoe's sends an ankle. */
export function withTrackers(renderer: WebGLRenderer, avatar: Avatar, read: () => BodyTrackers, frame: TrackingFrame) {
  const state: GuidedCalibration = stepGuidedCalibration(initialGuidedCalibration, frame, pinning);
  const measured = state.kind === 'done' ? state.calibration : defaultCalibration;
  const calibration = { ...measured, trackerOffsets: { ...measured.trackerOffsets, leftFoot: trackerAtJoint } };
  return new BodyTracker(renderer, { avatar, calibration, pinning, trackers: read });
}

/** For pages that expect the device's own body. */
export function polyfilled(frame: XRFrame & { readonly body?: EmulatedBody | null }): () => void {
  console.log(frame.body?.get('left-arm-lower')?.jointName, frame.body?.emulated);
  return installBodyTracking({ estimator: 'ik', calibration: 'auto', onWarning: (reason) => console.log(reason) });
}
