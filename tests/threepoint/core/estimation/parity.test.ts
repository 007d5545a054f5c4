import { averageSkeleton, chestSpaceBody, estimatedJoints } from 'threepoint/core';
import { sides } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { tiltRotation } from '../../../../src/threepoint/core/body/hand-tilt';
import type { JointName } from '../../../../src/threepoint/core/body/joints';
import { type HandTurn, solveIk } from '../../../../src/threepoint/core/estimation/ik/solve-ik';
import { transformJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import { paperFeatures } from '../../../../src/threepoint/core/estimation/methods/paper';
import { chestFeatureCount, chestFeatures } from '../../../../src/threepoint/core/estimation/networks/chest-features';
import { FeatureWindow } from '../../../../src/threepoint/core/estimation/networks/feature-window';
import { featureCount, frameFeatures } from '../../../../src/threepoint/core/estimation/networks/frame-features';
import {
  estimateHandTilt,
  makeHandTiltsState,
} from '../../../../src/threepoint/core/estimation/online-calibration/estimate-hand-tilts';
import { floorFromHeading } from '../../../../src/threepoint/core/tracking/heading';
import { type GoldenCase, goldenPoints, pointsInHeading, readGolden } from './golden';

const tolerance = 1e-5;
const cases = readGolden<GoldenCase[]>('features.json');

const expectNear = (actual: ArrayLike<number>, expected: readonly number[], what: string): void => {
  expect(actual.length, what).toBe(expected.length);
  for (let i = 0; i < expected.length; i++) {
    expect(Math.abs(actual[i]! - expected[i]!), `${what}[${i}]`).toBeLessThan(tolerance);
  }
};

/** How hands are turned in a frame. */
const turnsOf = ({ handTilts: [left = [], right = []] }: GoldenCase['frames'][number]) => {
  const turn = ([pitch = Number.NaN, yaw = Number.NaN]: readonly number[]) => tiltRotation({ pitch, yaw });
  return { left: turn(left), right: turn(right) };
};

describe.each(cases)('TypeScript agrees with Python for eyes at $calibration.eyeHeight m', (golden) => {
  const body = chestSpaceBody(golden.calibration);

  test('the calibrated skeleton', () => {
    const { restOffsets, eyesInHead } = averageSkeleton(golden.calibration);
    for (const [joint, offset] of Object.entries(golden.restOffsets)) {
      const ours = joint === 'eyesInHead' ? eyesInHead : restOffsets[joint as JointName];
      expectNear([ours.x, ours.y, ours.z], offset, joint);
    }
  });

  test('the IK solution in the floor frame', () => {
    for (const frame of golden.frames) {
      const points = goldenPoints(frame);
      const turns = turnsOf(frame);
      const { joints } = solveIk(pointsInHeading(points), (side) => turns[side], body);
      transformJoints(floorFromHeading(points.head), joints, joints);
      estimatedJoints.forEach((joint, index) => {
        const { x, y, z } = joints[joint];
        expectNear([x, y, z], frame.ikJoints[index]!, joint);
      });
    }
  });

  test('how hands stand to their forearms, observed frame by frame', () => {
    const state = makeHandTiltsState(golden.calibration.handTilts);
    let before = Number.NaN;
    for (const frame of golden.frames) {
      const points = goldenPoints(frame);
      const turnHand: HandTurn = (side, forearm) =>
        points.seen[side] ? estimateHandTilt(state, side, forearm, frame.time - before) : state.turns[side];
      solveIk(pointsInHeading(points), turnHand, body);
      const turns = turnsOf(frame);
      for (const side of sides) expect(state.turns[side]).toBeSameRotationAs(turns[side], 1e-4);
      before = frame.time;
    }
  });

  test('features, windowed in time and seen from the chest, and the paper’s input', () => {
    const window = new FeatureWindow(Math.max(...golden.window));
    const input = new Float32Array(golden.window.length * featureCount + chestFeatureCount);
    golden.frames.forEach((frame, index) => {
      const seen = goldenPoints(frame);
      const turns = turnsOf(frame);
      const points = pointsInHeading(seen);
      const solution = solveIk(points, (side) => turns[side], body);
      const features = frameFeatures(points, seen.seen, solution.joints, body, window.push(frame.time));
      expect(features.length).toBe(featureCount);
      expectNear(features, frame.features, `frame ${index}`);
      window.read(golden.window, input);
      chestFeatures(points, solution, body, input, golden.window.length * featureCount);
      expectNear(input, golden.inputs[index]!, `input ${index}`);
      const paperInput = paperFeatures(seen.head, seen.leftHand, seen.rightHand, floorFromHeading(seen.head));
      expectNear(paperInput, frame.paperInput, 'paper');
    });
  });
});
