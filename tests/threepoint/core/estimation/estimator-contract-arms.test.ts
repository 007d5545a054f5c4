import fc from 'fast-check';
import { type Calibration, headingOf, skeletonFromCalibration } from 'threepoint/core';
import {
  add,
  addScaled,
  cross,
  distance,
  dot,
  length,
  lerp,
  multiply,
  normalise,
  reject,
  rotate,
  rotationBetween,
  subtract,
  type TrackedPose,
  twistAngle,
  twistOf,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { armBones } from '../../../../src/threepoint/core/estimation/arms/fit-arms';
import { rotateInverse } from '../../../../src/threepoint/core/math/quat';
import { reportFigures } from '../../../reliability/report-figures';
import { evenly, rotation, vector } from '../arbitraries';
import { bodies, factIf, fitted, jointsOf, openSubject, person, rate, showSecond, times } from './contract-subjects';
import { type Joints, show } from './drawn';
import { withHand } from './moving-person';

/** How long the arms of this calibration are [m]. */
function reachOf(calibration: Calibration): number {
  const { upper, lower } = armBones(skeletonFromCalibration(calibration));
  return upper + lower;
}

describe.each(bodies)('$label', (subject) => {
  const { create, runs } = openSubject(subject);
  const fittedFact = factIf(fitted.includes(subject));

  test('the hands land on the wrists within reach, else a straight arm points at them', async () => {
    await fc.assert(
      fc.asyncProperty(person, async ({ at, calibration, start }) => {
        const estimator = create(calibration);
        const reach = reachOf(calibration);
        for (const time of times(start, 3)) {
          const frame = at(time);
          const joints = jointsOf(await show(estimator, frame), calibration);
          for (const side of ['left', 'right'] as const) {
            const wrist = frame[`${side}Hand`]!.position;
            const far = distance(joints[`${side}UpperArm`].position, wrist);
            const off = distance(joints[`${side}Hand`].position, wrist);
            expect(off).toBeLessThan(Math.max(far - reach, 0) + 1e-4);
          }
        }
      }),
      runs(100),
    );
  });

  fittedFact('a person who has the calibrated arms is never out of reach', async () => {
    await fc.assert(
      fc.asyncProperty(person, async ({ at, calibration, start }) => {
        const frame = at(start);
        const joints = jointsOf(await showSecond(create(calibration), at, start), calibration);
        expect(distance(joints.leftHand.position, frame.leftHand!.position)).toBeLessThan(1e-3);
        expect(distance(joints.rightHand.position, frame.rightHand!.position)).toBeLessThan(1e-3);
      }),
      runs(100),
    );
  });

  fittedFact('no wrist bends or twists more than 90° from its forearm', async () => {
    await fc.assert(
      fc.asyncProperty(person, rotation, async ({ at, calibration, start }, turn) => {
        const estimator = create(calibration);
        for (const time of times(start, 4)) {
          const frame = at(time);
          const rightHand = { ...frame.rightHand!, orientation: multiply(frame.rightHand!.orientation, turn) };
          const { body } = await show(estimator, { ...frame, rightHand });
          const along = vec3(1, 0, 0);
          const wrist = body!.localRotations.rightHand;
          const bend = Math.acos(Math.min(1, Math.max(-1, dot(rotate(wrist, along), along))));
          expect(bend).toBeLessThan(Math.PI / 2 + 1e-6);
          expect(Math.abs(twistAngle(twistOf(wrist, along), along))).toBeLessThan(Math.PI / 2 + 1e-6);
        }
      }),
      runs(50),
    );
  });

  fittedFact('an elbow goes steadily and never jumps to its arm’s other side, whatever hands do', async () => {
    const jolt = fc.record({ x: evenly(-0.5, 0.5), y: evenly(-0.4, 0.5), z: evenly(-0.6, 0.3) });
    let bentSteps = 0;
    await fc.assert(
      fc.asyncProperty(
        person,
        fc.array(jolt, { minLength: 3, maxLength: 3 }),
        rotation,
        async (wearer, jolts, turn) => {
          const estimator = create(wearer.calibration);
          let before: Joints | null = null;
          for (const [i, time] of times(wearer.start, 24).entries()) {
            // The hand glides by way of these places, turned anyhow: near the shoulder, behind, across the chest.
            const frame = wearer.at(wearer.start + 0.1 * (time - wearer.start));
            const [from, to] = [jolts[Math.floor(i / 12)]!, jolts[Math.floor(i / 12) + 1]!];
            const place = lerp(from, to, (i % 12) / 12);
            const chest = addScaled(frame.head.position, up, -0.3);
            const hand = add(chest, rotate(headingOf(frame.head.orientation), place));
            const rightHand: TrackedPose = { position: hand, orientation: turn, tracking: 'tracked' };
            const joints = jointsOf(await show(estimator, { ...frame, time, rightHand }), wearer.calibration);
            if (before) {
              const inChest = (j: Joints, v: Vec3) => rotateInverse(j.upperChest.orientation, v);
              const axis = (j: Joints) =>
                inChest(j, normalise(subtract(j.rightHand.position, j.rightUpperArm.position)));
              const pole = (j: Joints) =>
                reject(inChest(j, subtract(j.rightLowerArm.position, j.rightUpperArm.position)), axis(j));
              const carried = rotate(rotationBetween(axis(before), axis(joints)), pole(before));
              const bent = Math.min(length(pole(before)), length(pole(joints))) > 0.04;
              const angle = Math.atan2(length(cross(carried, pole(joints))), dot(carried, pole(joints)));
              // 12 rad/s, as the chest sees it that carries the arm.
              if (bent) {
                bentSteps += 1;
                expect(angle).toBeLessThan(12 * rate + 0.01);
              }
            }
            before = joints;
          }
        },
      ),
      runs(30),
    );
    expect(bentSteps).toBeGreaterThan(30);
  });

  fittedFact('a hand that is lost and found again never jumps, nor does its elbow', async () => {
    const loss = fc.record({
      side: fc.constantFrom('left' as const, 'right' as const),
      emulated: fc.boolean(),
      lostFor: evenly(0.05, 1.5),
      found: vector(0.25),
    });
    let longest = 0;
    await fc.assert(
      fc.asyncProperty(person, loss, async ({ at, calibration, start }, { side, emulated, lostFor, found }) => {
        const estimator = create(calibration);
        const still = at(start);
        const hand = still[`${side}Hand`]!;
        const back: TrackedPose = { ...hand, position: addScaled(hand.position, found, 0.5) };
        let before: Joints | null = null;
        for (const time of times(start, 150)) {
          const lost = time - start >= 0.2 && time - start < 0.2 + lostFor;
          const seen = time - start < 0.2 ? hand : back;
          const elsewhere: TrackedPose | null = emulated
            ? { ...hand, position: vec3(0, 0, 0), tracking: 'emulated' }
            : null;
          const frame = { ...withHand(still, side, lost ? elsewhere : seen), time };
          const joints = jointsOf(await show(estimator, frame), calibration);
          // The paper's network takes over from IK with its first answer, in the second frame: that is no loss.
          if (before && time - start > 0.1) {
            const step = distance(joints[`${side}Hand`].position, before[`${side}Hand`].position);
            longest = Math.max(longest, step);
            expect(step).toBeLessThan(0.05);
            expect(distance(joints[`${side}LowerArm`].position, before[`${side}LowerArm`].position)).toBeLessThan(
              0.065,
            );
          }
          before = joints;
        }
        // The hand may have been found further away than the arm is long.
        const far = distance(before![`${side}UpperArm`].position, back.position);
        const tooFar = Math.max(0, far - reachOf(calibration));
        expect(distance(before![`${side}Hand`].position, back.position)).toBeLessThan(tooFar + 1e-3);
      }),
      runs(20),
    );
    const figure = `${(100 * longest).toFixed(1)} cm in a frame of 60 Hz`;
    if (subject.plain) reportFigures('hand-lost', { 'longest step of a wrist': figure });
  });

  test('a hand that was never seen rests beside the hip, not at the origin', async () => {
    await fc.assert(
      fc.asyncProperty(person, async ({ at, calibration, start }) => {
        const frame = { ...at(start), leftHand: null, rightHand: null };
        const pose = await show(create(calibration), frame);
        expect([pose.leftHand, pose.rightHand]).toEqual([null, null]);
        const joints = jointsOf(pose, calibration);
        const below = (joint: Vec3) => Math.hypot(joint.x - joints.head.position.x, joint.z - joints.head.position.z);
        for (const side of ['left', 'right'] as const) {
          const { position } = joints[`${side}Hand`];
          expect(position.y).toBeLessThan(joints.chest.position.y);
          expect(below(position)).toBeLessThan(0.4 * calibration.eyeHeight);
        }
      }),
      runs(15),
    );
  });
});
