import fc from 'fast-check';
import { type Calibration, createEstimator, type TrackingFrame } from 'threepoint/core';
import { distance, fromAxisAngle, multiply, right } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { number, seed } from '../arbitraries';
import { poseOf } from './drawn';
import { movingPerson } from './moving-person';

const body: Calibration = { eyeHeight: 1.58, armSpan: 1.5 };

/** Returns the frame of a headset that points up by `pitch` [rad] when its wearer looks straight ahead. */
const tilted = (frame: TrackingFrame, pitch: number): TrackingFrame => ({
  ...frame,
  head: { ...frame.head, orientation: multiply(frame.head.orientation, fromAxisAngle(right, pitch)) },
});

describe('a headset that sits tilted', () => {
  test('bends the body as one that sits level, once calibration knows', () => {
    fc.assert(
      fc.property(number(-0.26, 0.26), fc.integer({ min: 0, max: 1000 }), (gazePitch, who) => {
        const person = movingPerson(who, body, { x: 0, z: 0, yaw: 0.4 });
        for (const name of ['hands-only', 'ik'] as const) {
          const level = createEstimator(name, body);
          const calibrated = createEstimator(name, { ...body, gazePitch });
          for (let i = 0; i < 30; i++) {
            const frame = person(i / 60);
            const wanted = poseOf(level, frame);
            const drawn = poseOf(calibrated, tilted(frame, gazePitch));
            expect(distance(drawn.head.position, wanted.head.position)).toBeLessThan(1e-9);
            expect(Math.abs(drawn.head.orientation.x - wanted.head.orientation.x)).toBeLessThan(1e-9);
            if (!drawn.body || !wanted.body) continue;
            expect(distance(drawn.body.hipsPosition, wanted.body.hipsPosition)).toBeLessThan(1e-6);
          }
        }
      }),
      { seed, numRuns: 20 },
    );
  });

  test('moves the pelvis by centimetres where no calibration knows of it', () => {
    const frame = movingPerson(3, body, { x: 0, z: 0, yaw: 0 })(1);
    const level = poseOf(createEstimator('ik', body), frame);
    const bent = poseOf(createEstimator('ik', body), tilted(frame, -0.2));
    if (!level.body || !bent.body) throw new Error('inverse kinematics draws a body');
    expect(distance(level.body.hipsPosition, bent.body.hipsPosition)).toBeGreaterThan(0.005);
  });

  test('another calibration counts from the next frame on', () => {
    const estimator = createEstimator('ik', { ...body, gazePitch: 0.2 });
    const frame = movingPerson(5, body, { x: 0, z: 0, yaw: 0 })(1);
    const first = poseOf(estimator, frame);
    estimator.calibrate(body);
    estimator.reset();
    const second = poseOf(estimator, frame);
    expect(first.head.orientation).not.toEqual(second.head.orientation);
    expect(second.head.orientation).toEqual(frame.head.orientation);
  });
});
