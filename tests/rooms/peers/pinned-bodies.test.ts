// @module-tag full
import { readFile } from 'node:fs/promises';
import {
  type AvatarPose,
  type Calibration,
  createEstimator,
  defaultCalibration,
  forwardKinematics,
  skeletonFromCalibration,
  type TrackingFrame,
} from 'threepoint/core';
import {
  add,
  addScaled,
  distance,
  fromAxisAngle,
  identity,
  multiply,
  type Pose,
  right,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { loadAvatar } from 'threepoint/three';
import { pinning } from 'threepoint/trackers';
import { expect, test } from 'vitest';
import { PlacedPose } from '../../../src/rooms/drawing/placed-pose';
import { RemoteBodies } from '../../../src/rooms/drawing/remote-bodies';
import { PoseSender } from '../../../src/rooms/peers/pose-sender';
import { RemotePoses } from '../../../src/rooms/peers/remote-poses';
import { poseOf } from '../../threepoint/core/estimation/drawn';
import { trackersOn, withOffsets } from '../../threepoint/core/estimation/tracked-body';

const frameMs = 1000 / 60;
const calibration: Calibration = defaultCalibration;
const skeleton = skeletonFromCalibration(calibration);

interface Posture {
  readonly head: Vec3;
  /** The turn of the head about +X [rad]; down is negative. */
  readonly nod: number;
  /** The turn of the pinned pelvis and thorax against the estimate, about +X [rad]. */
  readonly bend: number;
  /** Hips and chest joint by their trackers, from where they are estimated [m]. */
  readonly aside: Vec3;
  /** The right ankle; null: no tracker. */
  readonly rightFoot: Vec3 | null;
}

const eyes = calibration.eyeHeight;
const postures: readonly (readonly [string, Posture])[] = [
  [
    'standing, hips to the side',
    { head: vec3(0, eyes, 0), nod: 0, bend: 0.1, aside: vec3(0.05, 0, 0), rightFoot: null },
  ],
  [
    'a hollow back, a foot raised by 30 cm',
    { head: vec3(0, eyes, 0), nod: 0, bend: 0.3, aside: vec3(0, 0, -0.05), rightFoot: vec3(0.12, 0.38, -0.25) },
  ],
  [
    'bowed, a foot behind',
    {
      head: vec3(0, 0.75 * eyes, -0.35),
      nod: -0.8,
      bend: -0.3,
      aside: vec3(0, 0.02, 0.05),
      rightFoot: vec3(0.1, 0.2, 0.4),
    },
  ],
  [
    'crouched',
    {
      head: vec3(0.2, 0.55 * eyes, 0.1),
      nod: 0.2,
      bend: -0.4,
      aside: vec3(-0.04, 0, 0.04),
      rightFoot: vec3(0.3, 0.08, -0.1),
    },
  ],
];

const tracked = <T extends object>(pose: T) => ({ ...pose, tracking: 'tracked' as const });

/** A frame of a person in this posture whose hands and foot move, with trackers on hips, chest and the right ankle. */
function frameOf({ head, nod, bend, aside, rightFoot }: Posture, free: AvatarPose | null, time: number): TrackingFrame {
  const wave = 0.1 * Math.sin(3 * time);
  const hand = (x: number) =>
    tracked({ position: add(head, vec3(x, -0.45 + wave, -0.3)), orientation: fromAxisAngle(up, wave) });
  const frame = {
    time,
    head: tracked({ position: addScaled(head, right, 0.3 * wave), orientation: fromAxisAngle(right, nod) }),
    leftHand: hand(-0.25),
    rightHand: hand(0.25),
  };
  if (!free) return frame;
  const joints = forwardKinematics(skeleton, free.body!);
  const beside = ({ position, orientation }: Pose<'floor'>) => ({
    position: add(position, aside),
    orientation: multiply(fromAxisAngle(right, bend), orientation),
  });
  const goals = { hips: beside(joints.hips), chest: beside(joints.chest) };
  const foot = rightFoot && {
    position: addScaled(rightFoot, up, 0.5 * wave),
    orientation: fromAxisAngle(right, -wave),
  };
  return { ...frame, trackers: trackersOn(foot ? { ...goals, rightFoot: foot } : goals) };
}

/** A person in a posture whose body IK solves. */
function person(posture: Posture) {
  const [plain, pinned] = [
    createEstimator('ik', calibration),
    createEstimator('ik', withOffsets(calibration), null, { pinning }),
  ];
  return {
    calibration,
    pose: null as AvatarPose | null,
    moveTo(timeMs: number): void {
      const time = timeMs / 1000;
      this.pose = poseOf(pinned, frameOf(posture, poseOf(plain, frameOf(posture, null, time)), time));
    },
  };
}

const seen = ['head', 'hips', 'spine', 'chest', 'leftHand', 'rightHand', 'leftLowerArm', 'rightLowerArm'] as const;

test.each(postures)('others draw a person who is %s as the trackers pin the body', async (_, posture) => {
  const [ada, truth] = [person(posture), person(posture)];
  const avatar = await loadAvatar(await readFile('public/avatars/mannequin.vrm'));
  const others = new RemoteBodies({ avatar: async () => avatar });
  let now = 0;
  const sender = new PoseSender((bytes) => others.receive(now, 'ada', bytes), { name: 'Ada' });
  const worst = { joints: 0, foot: 0, drawnFoot: 0 };
  let compared = 0;
  for (; now < 2000; now += frameMs) {
    ada.moveTo(now);
    sender.update(now, ada);
    const [drawn] = others.update(now);
    await Promise.resolve();
    if (!drawn) continue;
    truth.moveTo(others.report('ada')!.shownTime * 1000);
    if (now < 1000) continue;
    const joints = forwardKinematics(skeleton, truth.pose!.body!);
    for (const joint of seen)
      worst.joints = Math.max(worst.joints, distance(drawn.joints![joint].position, joints[joint].position));
    compared += 1;
    const [foot, drawnFoot] = [truth.pose!.feet?.right ?? null, drawn.pose.feet?.right ?? null];
    expect(drawnFoot === null).toBe(posture.rightFoot === null);
    if (!foot || !drawnFoot) continue;
    worst.foot = Math.max(worst.foot, distance(foot.position, drawnFoot.position));
    expect(drawnFoot.orientation).toBeSameRotationAs(foot.orientation, 0.5);
    avatar.object.updateMatrixWorld(true);
    worst.drawnFoot = Math.max(worst.drawnFoot, distance(avatar.jointPositions().rightFoot!, foot.position));
  }
  others.dispose();
  expect(compared).toBeGreaterThan(50);
  expect(worst.joints).toBeLessThan(0.008);
  expect(worst.foot).toBeLessThan(0.002);
  expect(worst.drawnFoot).toBeLessThan(0.005);
});

test('a foot lost for a while is not drawn from its tracker; the other one is', () => {
  const [, raised] = postures[1]!;
  const ada = person(raised);
  const others = new RemotePoses();
  let now = 0;
  const sender = new PoseSender((bytes) => others.receive(now, 'ada', bytes), { name: 'Ada' });
  const feet: string[] = [];
  for (; now < 2000; now += frameMs) {
    ada.moveTo(now);
    const left = { position: vec3(-0.1, 0.2, 0), orientation: identity };
    const isLost = now > 800 && now < 1400;
    const pose = { ...ada.pose!, feet: { left, right: isLost ? null : ada.pose!.feet!.right } };
    sender.update(now, { pose, calibration });
    const shown = others.update(now)[0]?.pose.feet;
    const names = shown ? `${shown.left ? 'left' : ''} ${shown.right ? 'right' : ''}`.trim() : 'none';
    if (names !== feet.at(-1)) feet.push(names);
  }
  expect(feet.filter((names) => names !== 'none')).toEqual(['left right', 'left', 'left right']);
});

test('the feet of a body on a moved floor move with it', () => {
  const [, raised] = postures[1]!;
  const ada = person(raised);
  ada.moveTo(0);
  const moved = { position: vec3(2, 0, 1), orientation: fromAxisAngle(up, Math.PI / 2) };
  const { feet, body } = new PlacedPose().place(moved, ada.pose!);
  const foot = ada.pose!.feet!.right!.position;
  expect(distance(feet!.right!.position, vec3(2 + foot.z, foot.y, 1 - foot.x))).toBeLessThan(1e-9);
  const hips = ada.pose!.body!.hipsPosition;
  expect(distance(body!.hipsPosition, feet!.right!.position)).toBeCloseTo(distance(hips, foot), 9);
  expect(feet!.left).toBeNull();
});
