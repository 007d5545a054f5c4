import { Body, deviceJointNames } from 'threepoint';
import {
  actorFrame,
  createJointPoses,
  forwardKinematics,
  skeletonFromCalibration,
  type TrackingFrame,
} from 'threepoint/core';
import { expect, test } from 'vitest';
import { Measurements } from '../../../src/page/check/measurements';

const calibration = { eyeHeight: 1.6, armSpan: 1.5 };
const kinds = { left: 'hand', right: 'controller' } as const;

/** A body by inverse kinematics, and its frames. */
function wornBody() {
  const body = new Body({
    estimator: 'ik',
    calibration,
    networks: () => Promise.reject(new Error('there are no networks here')),
  });
  const measurements = new Measurements(body);
  return { body, measurements };
}

/** Our joints by the names that a device gives them. */
const deviceNames = {
  'left-arm-lower': 'leftLowerArm',
  'right-arm-lower': 'rightLowerArm',
  'left-arm-upper': 'leftUpperArm',
  'right-arm-upper': 'rightUpperArm',
  'spine-upper': 'chest',
  hips: 'hips',
} as const;

test('a device with elbows 3 cm from ours differs by 3 cm there and nowhere else', () => {
  const { body, measurements } = wornBody();
  const joints = createJointPoses();
  for (let row = 0; row < 200; row++) {
    const tracked: TrackingFrame = actorFrame(row / 60, calibration);
    const pose = body.update(tracked)!;
    forwardKinematics(skeletonFromCalibration(body.calibration), pose.body!, joints);
    const deviceBody = new Float32Array(3 * deviceJointNames.length);
    for (const [name, joint] of Object.entries(deviceNames)) {
      const { x, y, z } = joints[joint].position;
      const off = name.endsWith('arm-lower') ? 0.03 : 0;
      deviceBody.set([x, y + off, z], 3 * deviceJointNames.indexOf(name));
    }
    // Every fourth frame has no body of the device, as when it is lost.
    const frame = row % 4 === 0 ? tracked : { ...tracked, deviceBody };
    measurements.add({ time: tracked.time, tracked: frame, pose, kinds }, { kind: 'body' });
  }
  const { frames, joints: distances, complaint } = measurements.figures('lost').bodyTracking;
  expect([frames, complaint]).toEqual([150, null]);
  expect(distances!.leftLowerArm).toBeCloseTo(3, 3);
  expect(distances!.rightLowerArm).toBeCloseTo(3, 3);
  expect(distances!.hips).toBeCloseTo(0, 3);
});

test('a device without a body has a reason instead of figures', () => {
  const { measurements } = wornBody();
  expect(measurements.deviceBodySeen).toBe(false);
  expect(measurements.figures('the device reports no body').bodyTracking).toEqual({
    frames: 0,
    complaint: 'the device reports no body',
    joints: null,
  });
});

test('guessed hands are lost hands, menus count for nothing, and lead frames are left out', () => {
  const { measurements } = wornBody();
  const frame = (time: number, change: Partial<TrackingFrame>) => ({
    time,
    tracked: { ...actorFrame(0, calibration), time, ...change },
    pose: null,
    kinds,
  });
  const left = actorFrame(0, calibration).leftHand!;
  const [guessed, gone, menu] = [
    { leftHand: { ...left, tracking: 'emulated' as const } },
    { rightHand: null },
    { leftHand: null, rightHand: null, suspended: true as const },
  ];
  const frames = [{}, guessed, guessed, {}, gone, menu, menu, {}, {}];
  frames.forEach((change, row) => {
    measurements.add(frame(row / 10, guessed), null);
    measurements.add(frame(row / 10, change), { kind: 'losses' });
  });
  expect(measurements.figures(null).losses).toEqual([
    { hand: 'left', source: 'hand', observedSeconds: expect.closeTo(0.5, 9), lengthsMs: [200], openEnd: false },
    { hand: 'right', source: 'controller', observedSeconds: expect.closeTo(0.5, 9), lengthsMs: [], openEnd: false },
  ]);
});

test('latencies are median and 95th percentile; a browser without display times reports none', () => {
  const { measurements } = wornBody();
  expect(measurements.figures(null).latency).toEqual({ displayAhead: null, callbackDelay: null });
  for (let ms = 1; ms <= 100; ms++) measurements.addLatency(undefined, ms);
  expect(measurements.figures(null).latency).toEqual({
    displayAhead: null,
    callbackDelay: { frames: 100, p50Ms: 51, p95Ms: 96 },
  });
  measurements.addLatency(22, 1);
  expect(measurements.figures(null).latency.displayAhead).toEqual({ frames: 1, p50Ms: 22, p95Ms: 22 });
});

test('a latency whose median is negative is not known', () => {
  const { measurements } = wornBody();
  for (const aheadMs of [-3, -2, -1, 4]) measurements.addLatency(aheadMs, 1);
  expect(measurements.figures(null).latency.displayAhead).toBeNull();
});

test('trackers that moved or were not seen have a reason instead of a noise', () => {
  const { measurements } = wornBody();
  for (let row = 0; row < 600; row++) {
    const tracked: TrackingFrame = { ...actorFrame(0, calibration), time: row / 60, rightHand: null };
    const { position, orientation } = tracked.leftHand!;
    const moving = { ...position, x: position.x + 0.2 * Math.sin(row / 10) };
    const leftHand = { position: moving, orientation, tracking: 'tracked' as const };
    measurements.add({ time: tracked.time, tracked: { ...tracked, leftHand }, pose: null, kinds }, { kind: 'noise' });
  }
  const { noise, unmeasured } = measurements.figures(null);
  expect(noise.map(({ tracker, frames }) => [tracker, frames])).toEqual([['head', 600]]);
  expect(unmeasured).toEqual([
    { tracker: 'left', frames: 600, moved: true },
    { tracker: 'right', frames: 0, moved: false },
  ]);
});
