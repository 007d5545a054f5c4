import { estimatedJoints, headingOf, skeletonFromCalibration, type TrackingFrame } from 'threepoint/core';
import {
  angleBetween,
  distance,
  fromAxisAngle,
  multiply,
  type Quat,
  rotate,
  subtract,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { driveFrames, pipelineDriver } from '../../bench/evaluate/drive';
import {
  createWithWindows,
  type TrackedPoints,
  windowFeatures,
  windowInputs,
} from '../../bench/evaluate/window-source';
import { createCcdBody } from '../../bench/page/ccd-body';
import { readGolden } from '../threepoint/core/estimation/golden';
import { readShipped } from '../threepoint/core/estimation/shipped-models';
import { person, recordedMotion } from './recorded-motion';

const motion = recordedMotion(5, 90);
const pointsOf = ({ head, leftHand, rightHand }: TrackingFrame): TrackedPoints => ({
  head,
  leftHand: leftHand!,
  rightHand: rightHand!,
});
const points = motion.map(({ frame }) => pointsOf(frame));
/** The yaw of a line from the left to the right, as a rotation. */
const yawOf = ({ x, z }: Vec3): Quat => fromAxisAngle(up, Math.atan2(-z, x));
const furthest = (a: ArrayLike<number>, b: ArrayLike<number>): number =>
  Math.max(...Array.from(a, (value, index) => Math.abs(value - b[index]!)));

describe('the input of the networks of the board', () => {
  test('agrees with Python on golden windows', () => {
    type Numbers = readonly number[];
    const [golden] =
      readGolden<{ calibration: typeof person; positions: Numbers[][]; rotations: Numbers[][]; features: Numbers }[]>(
        'windows.json',
      );
    const { positions, rotations, features, calibration } = golden!;
    const frames = positions.map((row, index) => {
      const [head, leftHand, rightHand] = row.map(([x, y, z], tracker) => {
        const [qx, qy, qz, qw] = rotations[index]![tracker]!;
        return { position: vec3(x!, y!, z!), orientation: { x: qx!, y: qy!, z: qz!, w: qw! } };
      });
      return { head: head!, leftHand: leftHand!, rightHand: rightHand! };
    });
    expect(features).toHaveLength(windowInputs);
    expect(furthest(windowFeatures(frames, calibration), features)).toBeLessThan(1e-5);
  });

  test('is the same for a person who is turned and stands elsewhere', () => {
    const turn = fromAxisAngle(up, 2.1);
    const moved = points.map((frame) => {
      const poses = Object.entries(frame).map(([tracker, { position, orientation }]) => {
        const { x, y, z } = rotate(turn, position);
        return [tracker, { position: vec3(x + 3, y, z - 1), orientation: multiply(turn, orientation) }];
      });
      return Object.fromEntries(poses) as TrackedPoints;
    });
    expect(furthest(windowFeatures(moved, person), windowFeatures(points, person))).toBeLessThan(1e-5);
  });

  test('has no velocity before the first frame', () => {
    const [first] = points;
    const features = windowFeatures([first!], person);
    const velocities = Array.from({ length: 40 }, (_, frame) => features.subarray(54 * frame + 45, 54 * frame + 54));
    expect(velocities.every((velocity) => velocity.every((value) => value === 0))).toBe(true);
  });
});

test('joints of the field follow the heading of the newest frame while a person turns', async () => {
  const { contract } = readShipped('learned');
  const inHeading = estimatedJoints.flatMap((_, index) => [0.1 * index - 0.2, 0.6 + 0.05 * index, 0.1]);
  const constant = {
    contract,
    provider: 'plain',
    run: async () => Float32Array.from(inHeading),
    dispose: async () => undefined,
  };
  const driver = pipelineDriver('transformer', createWithWindows(person, constant), person);
  const driven = await driveFrames(driver, motion);
  for (const [row, { raw }] of driven.entries()) {
    const { position, orientation } = motion[row]!.frame.head;
    const [x, y, z] = inHeading.slice(3).map((value) => value * person.eyeHeight);
    const turned = rotate(headingOf(orientation), vec3(x!, y!, z!));
    expect(distance(raw!.rightLowerArm, vec3(position.x + turned.x, turned.y, position.z + turned.z))).toBeLessThan(
      1e-5,
    );
  }
});

describe("three's solver", () => {
  test('puts the head joint below the headset and both hands near the controllers', () => {
    const skeleton = skeletonFromCalibration(person);
    const body = createCcdBody(skeleton);
    const misses = motion.map(({ frame }) => {
      body.solve(frame);
      const { head, leftHand, rightHand } = body.joints();
      expect(
        distance(head!, subtract(frame.head.position, rotate(frame.head.orientation, skeleton.eyesInHead))),
      ).toBeLessThan(0.01);
      return Math.max(distance(leftHand!, frame.leftHand!.position), distance(rightHand!, frame.rightHand!.position));
    });
    expect(misses.filter((miss) => miss < 0.02).length).toBeGreaterThan(0.8 * misses.length);
  });

  test('faces where the head does', () => {
    const body = createCcdBody(skeletonFromCalibration(person));
    for (const { frame } of motion) {
      body.solve(frame);
      const { leftShoulder, rightShoulder } = body.joints();
      const facing = yawOf(subtract(rightShoulder!, leftShoulder!));
      expect(angleBetween(facing, headingOf(frame.head.orientation))).toBeLessThan(0.3);
    }
  });

  test('leaves a hand that is not seen where it was', () => {
    const body = createCcdBody(skeletonFromCalibration(person));
    const [first] = motion;
    body.solve(first!.frame);
    const before = body.joints().leftHand!;
    body.solve({ ...first!.frame, leftHand: null });
    expect(distance(body.joints().leftHand!, before)).toBeLessThan(0.01);
  });
});
