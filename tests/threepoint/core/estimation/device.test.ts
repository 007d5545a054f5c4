import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { defaultCalibration } from '../../../../src/threepoint/core/body/calibration';
import { type EstimatedJoint, estimatedJoints } from '../../../../src/threepoint/core/body/joints';
import { createEstimator, createIk } from '../../../../src/threepoint/core/estimation/estimators';
import { copyJoints, type JointPositions, mapJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import type { Pipeline } from '../../../../src/threepoint/core/estimation/pipeline';
import { add, distance, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import { deviceBodySize, deviceJointNames } from '../../../../src/threepoint/core/tracking/device-body';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { number, seed } from '../arbitraries';
import { numbersIn } from '../numbers-in';
import { calibrationOf, person, rate, times } from './contract-subjects';
import { movingPerson } from './moving-person';

const calibration = defaultCalibration;
const frameAt = movingPerson(7, calibration, { x: 1, z: -2, yaw: 1 });

/** What the device calls the six joints, the head and the wrists. */
const names: Readonly<Record<string, string>> = {
  ...{ hips: 'hips', chest: 'spine-upper', leftUpperArm: 'left-arm-upper', rightUpperArm: 'right-arm-upper' },
  ...{ leftLowerArm: 'left-arm-lower', rightLowerArm: 'right-arm-lower', head: 'head' },
  ...{ leftHand: 'left-hand-wrist', rightHand: 'right-hand-wrist' },
};

/** A person whose device sees their joints a little elsewhere than IK guesses, and IK's own six joints beside it. */
function seenPerson(measures = calibration, at = frameAt) {
  const ik = createIk(measures);
  const off = mapJoints((_, index) => vec3(0.03, -0.02, 0.01 * index));
  return (time: number) => {
    const frame = at(time);
    ik.update(frame);
    const { completed } = ik.state.solved;
    const guessed = copyJoints(ik.state.joints);
    const body = new Float32Array(deviceBodySize);
    const place = (joint: string, where: Vec3) =>
      body.set([where.x, where.y, where.z], 3 * deviceJointNames.indexOf(names[joint] ?? ''));
    const truth = mapJoints((joint) => add(guessed[joint], off[joint]));
    for (const joint of estimatedJoints) place(joint, truth[joint]);
    place('head', completed.headJoint);
    place('leftHand', completed.leftHand.position);
    place('rightHand', completed.rightHand.position);
    return { frame, guessed, truth, body, place };
  };
}

const device = (measures = calibration) => createEstimator('device', measures) as Pipeline;
const jointsAfter = (estimator: Pipeline, frame: TrackingFrame): JointPositions => {
  estimator.update(frame);
  return copyJoints(estimator.state.joints);
};
const farthest = (a: JointPositions, b: JointPositions): number =>
  Math.max(...estimatedJoints.map((joint) => distance(a[joint], b[joint])));

describe('the device’s body', () => {
  test('is what is drawn, from its first frame on', () => {
    fc.assert(
      fc.property(person, ({ at, calibration, start }) => {
        const seen = seenPerson(calibration, at);
        const estimator = device(calibration);
        for (const time of times(start, 3)) {
          const { frame, truth, body } = seen(time);
          expect(farthest(jointsAfter(estimator, { ...frame, deviceBody: body }), truth)).toBeLessThan(1e-5);
        }
      }),
      { seed, numRuns: 30 },
    );
  });

  test('gives way to another source within 0.3 s of its loss, and returns as slowly, smoothly', () => {
    const seen = seenPerson();
    const estimator = device();
    let before: JointPositions | null = null;
    for (const [index, time] of times(10, 180).entries()) {
      const { frame, guessed, truth, body } = seen(time);
      const lost = index >= 60 && index < 120;
      const joints = jointsAfter(estimator, lost ? frame : { ...frame, deviceBody: body });
      if (index === 59 || index === 179) expect(farthest(joints, truth)).toBeLessThan(1e-5);
      if (index === 119) expect(farthest(joints, guessed)).toBeLessThan(1e-9);
      // The way from the one to the other is 7 cm: no frame goes more than a share of it beside the person's own.
      if (before) expect(farthest(joints, before)).toBeLessThan(0.03);
      before = joints;
    }
  });

  test('is another’s where it is far from the head, and no distant arm is followed', () => {
    const drawn = (stray: string, by: Vec3) => {
      const { frame, guessed, truth, body, place } = seenPerson()(10);
      const at = 3 * deviceJointNames.indexOf(names[stray] ?? '');
      place(stray, add(vec3(body[at]!, body[at + 1]!, body[at + 2]!), by));
      const joints = jointsAfter(device(), { ...frame, deviceBody: body });
      return {
        followed: estimatedJoints.filter((joint) => distance(joints[joint], truth[joint]) < 1e-5),
        joints,
        guessed,
      };
    };
    const other = drawn('head', vec3(1, 0, 0));
    expect(other.followed).toEqual([]);
    expect(farthest(other.joints, other.guessed)).toBeLessThan(1e-9);
    const all: readonly EstimatedJoint[] = estimatedJoints;
    expect(drawn('leftHand', vec3(0, 0.4, 0)).followed).toEqual(all.filter((joint) => joint !== 'leftLowerArm'));
    expect(drawn('leftHand', vec3(0, 0.04, 0)).followed).toEqual(all);
  });

  test('keeps an arm whose hand the trackers lost as long as both agree', () => {
    const estimator = device();
    const seen = seenPerson();
    jointsAfter(estimator, { ...seen(10).frame, deviceBody: seen(10).body });
    for (const time of times(10 + rate, 90)) {
      const { frame, truth, body } = seen(time);
      const joints = jointsAfter(estimator, { ...frame, leftHand: null, deviceBody: body });
      expect(distance(joints.rightLowerArm, truth.rightLowerArm)).toBeLessThan(1e-5);
      expect(numbersIn(joints).every(Number.isFinite)).toBe(true);
    }
  });

  test('anywhere finite leaves head and hands alone and makes no NaN', () => {
    const bodies = fc
      .array(number(-5, 5), { minLength: deviceBodySize, maxLength: deviceBodySize })
      .map((all) => Float32Array.from(all));
    fc.assert(
      fc.property(calibrationOf, bodies, fc.boolean(), (measures, deviceBody, own) => {
        const frame = movingPerson(3, measures, { x: 0, z: 0, yaw: 2 })(10);
        const { x, y, z } = frame.head.position;
        // Half of them pass for the wearer's own, by their head.
        if (own) deviceBody.set([x, y, z], 3 * deviceJointNames.indexOf('head'));
        const { pose } = device(measures).update({ ...frame, deviceBody });
        expect(pose.head).toEqual(frame.head);
        expect(numbersIn(pose.body).every(Number.isFinite)).toBe(true);
      }),
      { seed, numRuns: 40 },
    );
  });
});
