import { defaultCalibration, type EstimatorName, type PaperMethod, type TrackingFrame } from 'threepoint/core';
import type { TrackedPose } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { Body } from '../../../src/threepoint/api/body';
import { deviceBodySize } from '../../../src/threepoint/core/tracking/device-body';
import { TrackingGate } from '../../../src/threepoint/core/tracking/tracking-gate';
import { movingPerson } from '../core/estimation/moving-person';
import { openPlainModel } from '../core/estimation/shipped-models';
import { numbersIn } from '../core/numbers-in';

const calibration = defaultCalibration;
const at = movingPerson(3, calibration, { x: 1, z: -0.5, yaw: 2 });
const rate = 60;

const nowhere = { x: Number.NaN, y: 1, z: 0 };
const noRotation = { x: 0, y: 0, z: 0, w: 0 };

const placeOf = ({ position, orientation }: TrackedPose) => ({ position, orientation });
// reason: of a page without types
const withoutTracking = ({ time, head, leftHand, rightHand }: TrackingFrame) =>
  ({ time, head: placeOf(head), leftHand: placeOf(leftHand!), rightHand: placeOf(rightHand!) }) as TrackingFrame;

/** A frame with one thing in it that no tracker means. */
const slips: readonly (readonly [what: string, slip: (frame: TrackingFrame) => TrackingFrame])[] = [
  ['a hand that is nowhere', (frame) => ({ ...frame, leftHand: { ...frame.leftHand!, position: nowhere } })],
  ['a hand without a rotation', (frame) => ({ ...frame, rightHand: { ...frame.rightHand!, orientation: noRotation } })],
  [
    'a hand too far to be measured',
    (frame) => ({ ...frame, leftHand: { ...frame.leftHand!, position: { x: 1e300, y: 0, z: 0 } } }),
  ],
  ['a head that is nowhere', (frame) => ({ ...frame, head: { ...frame.head, position: nowhere } })],
  ['a head without a rotation', (frame) => ({ ...frame, head: { ...frame.head, orientation: noRotation } })],
  ['a time that is no number', (frame) => ({ ...frame, time: Number.NaN })],
  ['a time without end', (frame) => ({ ...frame, time: Number.POSITIVE_INFINITY })],
  // reason: a page without types leaves out what it does not see
  ['no word of its hands', ({ time, head }) => ({ time, head }) as TrackingFrame],
  // reason: of a page without types
  ['a head that is null', (frame) => ({ ...frame, head: null }) as unknown as TrackingFrame],
  ['no word of how its points are tracked', withoutTracking],
  [
    'a device’s body that is nowhere',
    (frame) => ({ ...frame, deviceBody: new Float32Array(deviceBodySize).fill(Number.NaN) }),
  ],
  ['a device’s body of too few joints', (frame) => ({ ...frame, deviceBody: new Float32Array(3) })],
];

async function bodyBy(estimator: EstimatorName) {
  const faults: string[] = [];
  const body = new Body<PaperMethod>({ estimator, calibration, networks: async () => openPlainModel() });
  body.addEventListener('fallback', ({ estimator, reason }) => faults.push(`${estimator} ${reason}`));
  await body.setEstimator(estimator);
  return { body, faults };
}

describe.each(['ik', 'learned', 'device'] as const)('a body by %s', (estimator) => {
  /** What it draws in the end of frames of which one is another. */
  async function drawn(slip: (frame: TrackingFrame) => TrackingFrame) {
    const { body, faults } = await bodyBy(estimator);
    for (let i = 0; i <= rate; i++) {
      const pose = body.update(i === 10 ? slip(at(i / rate)) : at(i / rate));
      expect(numbersIn(pose).every(Number.isFinite)).toBe(true);
    }
    expect(faults).toEqual([]);
    expect(body.estimator).toBe(estimator);
    return numbersIn(body.pose);
  }
  const whole = drawn((frame) => frame);

  test.each(slips)('has no part in one frame with %s, and none of it stays', async (_, slip) => {
    const healed = await drawn(slip);
    const furthest = (await whole).map((number, i) => Math.abs(number - healed[i]!));
    expect(Math.max(...furthest)).toBeLessThan(0.02);
  });
});

test('a point that is no place is lost for its frame, and found again', async () => {
  const reported: string[] = [];
  const body = new Body({ estimator: 'ik', calibration });
  body.addEventListener('trackinglost', ({ point }) => reported.push(`lost ${point}`));
  body.addEventListener('trackingfound', ({ point }) => reported.push(`found ${point}`));
  body.update(at(0));
  body.update({ ...at(1 / rate), leftHand: { ...at(1 / rate).leftHand!, position: nowhere } });
  const shown = JSON.stringify(body.update(at(2 / rate)));
  expect(JSON.stringify(body.update({ ...at(3 / rate), head: { ...at(0).head, position: nowhere } }))).toBe(shown);
  expect(reported).toEqual([
    ...['found head', 'found left', 'found right', 'lost left', 'found left'],
    ...['lost head', 'lost left', 'lost right'],
  ]);
});

test('a point of a page that does not say how it is tracked is there', () => {
  const bodies = [new Body({ estimator: 'ik', calibration }), new Body({ estimator: 'ik', calibration })] as const;
  expect(bodies[0].update(withoutTracking(at(0)))?.body).toEqual(bodies[1].update(at(0))?.body);
});

test('a rotation of another length than 1, as from mixed quaternions, counts as its direction', () => {
  const bodies = [new Body({ estimator: 'ik', calibration }), new Body({ estimator: 'ik', calibration })] as const;
  const frame = at(0);
  const longer = (pose: TrackedPose, by: number): TrackedPose => {
    const { x, y, z, w } = pose.orientation;
    return { ...pose, orientation: { x: by * x, y: by * y, z: by * z, w: by * w } };
  };
  const mixed = { ...frame, head: longer(frame.head, 0.9), leftHand: longer(frame.leftHand!, 2) };
  const [drawn, whole] = [bodies[0].update(mixed)!, bodies[1].update(frame)!];
  for (const [i, number] of numbersIn(drawn).entries()) expect(number).toBeCloseTo(numbersIn(whole)[i]!, 9);
});

test('a time that is no number is the last frame’s; before any, nothing is seen', () => {
  const body = new Body({ estimator: 'ik', calibration });
  expect(body.update({ ...at(0), time: Number.NaN })).toBeNull();
  body.update(at(1));
  const still = body.update({ ...at(1), time: Number.NaN });
  expect(still?.head).toEqual(at(1).head);
});

test('a body is warmed up without invalid points', async () => {
  const { body } = await bodyBy('learned');
  const frames = Array.from({ length: rate }, (_, i) => at(i / rate));
  await body.warmUp(frames.map((frame, i) => (i % 7 === 3 ? slips[i % slips.length]![1](frame) : frame)));
  expect(body.pose).not.toBeNull();
  expect(numbersIn(body.pose).every(Number.isFinite)).toBe(true);
});

test('a frame without a slip is taken as it is: nothing is copied', () => {
  const gate = new TrackingGate();
  const whole = { ...at(0), deviceBody: new Float32Array(deviceBodySize) };
  for (const frame of [at(0), { ...at(0), leftHand: null }, whole]) expect(gate.validate(frame)).toBe(frame);
});
