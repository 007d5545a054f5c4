import { describe, expect, test } from 'vitest';
import { estimatedJoints, type JointName } from '../../../src/core/body/joints';
import { chestSpaceBody, skeletonFromCalibration } from '../../../src/core/body/skeleton';
import { viewFromChest } from '../../../src/core/estimation/chest-view';
import { createFeatureWindow, featureCount, frameFeatures } from '../../../src/core/estimation/features';
import { pointsInHeading } from '../../../src/core/estimation/ik';
import { transformJoints } from '../../../src/core/estimation/joint-positions';
import { paperFeatures } from '../../../src/core/estimation/paper-features';
import { solveIk } from '../../../src/core/estimation/solve-ik';
import { floorFromHeading } from '../../../src/core/tracking/heading';
import { continuedFrame, type GoldenCase, readGolden } from './golden';

const tolerance = 1e-5;
const cases = readGolden<GoldenCase[]>('features.json');

const expectNear = (actual: ArrayLike<number>, expected: readonly number[], what: string): void => {
  expect(actual.length, what).toBe(expected.length);
  for (let i = 0; i < expected.length; i++) {
    expect(Math.abs(actual[i]! - expected[i]!), `${what}[${i}]`).toBeLessThan(tolerance);
  }
};

describe.each(cases)('TypeScript agrees with Python for eyes at $calibration.eyeHeight m', (golden) => {
  const body = chestSpaceBody(golden.calibration);

  test('the calibrated skeleton', () => {
    const { restOffsets, eyesInHead } = skeletonFromCalibration(golden.calibration);
    for (const [joint, offset] of Object.entries(golden.restOffsets)) {
      const ours = joint === 'eyesInHead' ? eyesInHead : restOffsets[joint as JointName];
      expectNear([ours.x, ours.y, ours.z], offset, joint);
    }
  });

  test('the IK solution in the floor frame', () => {
    for (const frame of golden.frames) {
      const continued = continuedFrame(frame);
      const joints = transformJoints(floorFromHeading(continued.head), solveIk(pointsInHeading(continued), body));
      estimatedJoints.forEach((joint, index) => {
        const { x, y, z } = joints[joint];
        expectNear([x, y, z], frame.ikJoints[index]!, joint);
      });
    }
  });

  test('features, windowed in time and seen from the chest, and the paper’s input', () => {
    const window = createFeatureWindow(Math.max(...golden.window));
    golden.frames.forEach((frame, index) => {
      const continued = continuedFrame(frame);
      const points = pointsInHeading(continued);
      const features = frameFeatures(
        points,
        { left: continued.leftHand.seen, right: continued.rightHand.seen },
        solveIk(points, body),
        body,
      );
      expect(features.length).toBe(featureCount);
      expectNear(features, frame.features, `frame ${index}`);
      window.push(frame.time, features);
      const input = [...window.read(golden.window), ...viewFromChest(features).features];
      expectNear(input, golden.inputs[index]!, `input ${index}`);
      expectNear(paperFeatures(continued.head, continued.leftHand, continued.rightHand), frame.paperInput, 'paper');
    });
  });
});
