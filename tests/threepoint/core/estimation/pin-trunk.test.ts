import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { Calibration } from '../../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import { headJointOf } from '../../../../src/threepoint/core/body/head-joint';
import { type JointName, jointNames, parentOf } from '../../../../src/threepoint/core/body/joints';
import { chestSpaceBody, skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import { type TrackerOffsets, trackerAtJoint } from '../../../../src/threepoint/core/body/tracker-offsets';
import { createEstimator } from '../../../../src/threepoint/core/estimation/estimators';
import { pinning } from '../../../../src/threepoint/core/estimation/pinning';
import type { TrackerMismatch } from '../../../../src/threepoint/core/estimation/tracker-watch';
import { type Pose, type TrackedPose, transformPoint } from '../../../../src/threepoint/core/math/pose';
import { angleBetween, identity, multiply, rotate } from '../../../../src/threepoint/core/math/quat';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import {
  add,
  addScaled,
  distance,
  length,
  normalise,
  subtract,
  type Vec3,
  vec3,
  zero,
} from '../../../../src/threepoint/core/math/vec3';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { cases } from '../../../nightly';
import { evenly, seed, standpoint } from '../arbitraries';
import { fromEulerYxz } from '../euler-angles';
import { fitted, jointsOf, openSubject, person, rate, times } from './contract-subjects';
import { type Joints, poseOf, show } from './drawn';
import { movingPerson } from './moving-person';
import { at, calibration } from './posed-body';
import { createPinned, type TrueJoints, trackersOn, withOffsets } from './tracked-body';

type Place = { readonly x: number; readonly y: number; readonly z: number };
const aside = fc.record({ x: evenly(-1, 1), y: evenly(-1, 1), z: evenly(-1, 1) });
const turn = fc.record({ x: evenly(-0.3, 0.3), y: evenly(-0.5, 0.5), z: evenly(-0.3, 0.3) });

const headJointIn = (frame: TrackingFrame, body: Calibration): Vec3 =>
  headJointOf(frame.head, skeletonFromCalibration(body).eyesInHead, vec3(0, 0, 0));

/** The point moved towards the head, no further from it than `most` [m]. */
function within(point: Vec3, headJoint: Vec3, most: number): Vec3 {
  const way = subtract(point, headJoint);
  return addScaled(headJoint, normalise(way), Math.min(length(way), most));
}

/**
 * The pose of a joint that a body drawn without trackers could have had instead: up to 7 cm aside, turned, and within
 * the bones' reach.
 */
function elsewhere(joint: Pose<'floor'>, to: Place, about: Place, headJoint: Vec3, most: number): Pose<'floor'> {
  const position = within(addScaled(joint.position, to, 0.04), headJoint, most);
  return { position, orientation: multiply(joint.orientation, fromEulerYxz(about)) };
}

type Goals = { readonly hips: Pose<'floor'>; readonly chest: Pose<'floor'> };

/** Returns where a tracker says that a joint is which wanders about it by up to `far` [m] and turns by about 40°. */
function wandering(random: () => number, far: number): (joint: Pose<'floor'>, time: number) => Pose<'floor'> {
  const wave = (amplitude: number) => {
    const parts = [1, 2, 3].map(() => ({ speed: 0.3 + 2 * random(), phase: 7 * random() }));
    return (time: number) =>
      parts.reduce((sum, { speed, phase }) => sum + amplitude * Math.sin(speed * time + phase), 0);
  };
  const [place, turns] = [[1, 2, 3].map(() => wave(far / 1.5)), [1, 2, 3].map(() => wave(0.27))];
  const vectorAt = (waves: typeof place, time: number) => vec3(waves[0]!(time), waves[1]!(time), waves[2]!(time));
  return ({ position, orientation }, time) => ({
    position: add(position, vectorAt(place, time)),
    orientation: multiply(orientation, fromEulerYxz(vectorAt(turns, time))),
  });
}

/** How far a pose has moved [m]; a turn counts as the way of a point 20 cm away. */
const movedBetween = (from: Pose<'floor'>, to: Pose<'floor'>): number =>
  distance(from.position, to.position) + 0.2 * angleBetween(from.orientation, to.orientation);

const reaches = (body: Calibration) => {
  const { neckToHead, thorax, lowerBack } = chestSpaceBody(body);
  const chest = length(neckToHead) + thorax;
  return { chest: chest - 0.002, hips: chest + lowerBack - 0.002 };
};

function expectWhole(joints: Joints, body: Calibration): void {
  const { restOffsets } = skeletonFromCalibration(body);
  for (const joint of jointNames) {
    const parent = parentOf[joint];
    if (parent === null) continue;
    const bone = distance(at(joints, joint), at(joints, parent));
    expect(Math.abs(bone - length(restOffsets[joint]))).toBeLessThan(1e-6);
    expect(distance(transformPoint(joints[parent], restOffsets[joint]), at(joints, joint))).toBeLessThan(1e-6);
  }
}

describe.each(fitted)('$label with trackers', (subject) => {
  const { create, runs } = openSubject(subject);

  test.each([['hips'], ['chest']] as const)('draws a moving person’s %s within 1 mm of the tracker', async (name) => {
    await fc.assert(
      fc.asyncProperty(person, aside, turn, async ({ at: frameAt, calibration: body, start }, to, about) => {
        const [plain, pinned] = [create(body), create(withOffsets(body), { pinning })];
        for (const time of times(start, 4)) {
          const frame = frameAt(time);
          const headJoint = headJointIn(frame, body);
          const free = jointsOf(await show(plain, frame), body);
          const goal = elsewhere(free[name], to, about, headJoint, reaches(body)[name]);
          const trackers = trackersOn({ [name]: goal });
          const pose = await show(pinned, { ...frame, trackers });
          const joints = jointsOf(pose, body);
          expect(distance(at(joints, name), goal.position)).toBeLessThan(1e-3);
          expectWhole(joints, body);
          const eyes = add(
            at(joints, 'head'),
            rotate(joints.head.orientation, skeletonFromCalibration(body).eyesInHead),
          );
          expect(distance(eyes, frame.head.position)).toBeLessThan(1e-6);
        }
      }),
      runs(50),
    );
  });
});

describe('a pinned trunk', () => {
  const draw = (estimator: ReturnType<typeof createEstimator>, frame: TrackingFrame): Joints =>
    jointsOf(poseOf(estimator, frame), calibration);
  const drawTracked = (frame: TrackingFrame, joints: TrueJoints): Joints =>
    draw(createPinned(calibration), { ...frame, trackers: trackersOn(joints) });

  test('turns the hips like their tracker where the back reaches so far', () => {
    fc.assert(
      fc.property(fc.integer(), standpoint, turn, (motion, place, about) => {
        const frame = movingPerson(motion, calibration, place)(0);
        const free = draw(createEstimator('ik', calibration), frame);
        const headJoint = headJointIn(frame, calibration);
        const goal = elsewhere(free.hips, vec3(0, 0, 0), about, headJoint, reaches(calibration).hips - 0.06);
        const joints = drawTracked(frame, { hips: goal });
        expect(distance(at(joints, 'hips'), goal.position)).toBeLessThan(1e-3);
        expect(joints.hips.orientation).toBeSameRotationAs(goal.orientation);
      }),
      { seed, numRuns: cases(50) },
    );
  });

  test('holds hips and chest where both are possible, and the hips where they are not', () => {
    fc.assert(
      fc.property(fc.integer(), standpoint, evenly(-0.08, 0.08), (motion, place, apart) => {
        const frame = movingPerson(motion, calibration, place)(0);
        const free = draw(createEstimator('ik', calibration), frame);
        const chest = { ...free.chest, position: add(at(free, 'chest'), vec3(0, apart, 0)) };
        const joints = drawTracked(frame, { hips: free.hips, chest });
        expect(distance(at(joints, 'hips'), at(free, 'hips'))).toBeLessThan(1e-3);
        if (apart === 0) expect(distance(at(joints, 'chest'), at(free, 'chest'))).toBeLessThan(1e-3);
        expectWhole(joints, calibration);
      }),
      { seed, numRuns: cases(50), examples: [[3, { x: 0, z: 0, yaw: 1 }, 0]] },
    );
  });

  test('keeps the hands that it reaches on their controllers', () => {
    fc.assert(
      fc.property(fc.integer(), standpoint, aside, (motion, place, to) => {
        const frame = movingPerson(motion, calibration, place)(0);
        const free = draw(createEstimator('ik', calibration), frame);
        const headJoint = headJointIn(frame, calibration);
        const goal = elsewhere(free.hips, to, vec3(0, 0, 0), headJoint, reaches(calibration).hips);
        const joints = drawTracked(frame, { hips: goal });
        expect(distance(at(joints, 'leftHand'), frame.leftHand!.position)).toBeLessThan(2e-3);
        expect(distance(at(joints, 'rightHand'), frame.rightHand!.position)).toBeLessThan(2e-3);
      }),
      { seed, numRuns: cases(50) },
    );
  });

  test('ignores a tracker without offset, a guessed or invalid one, and one beside another person', () => {
    const frame = movingPerson(4, calibration, { x: 1, z: 2, yaw: 0.4 })(3);
    const free = poseOf(createEstimator('ik', calibration), frame);
    const hips = jointsOf(free, calibration).hips;
    const { hips: seen } = trackersOn({ hips });
    const drawn = (body: Calibration, trackers: TrackingFrame['trackers']) =>
      poseOf(createEstimator('ik', body, null, { pinning }), { ...frame, trackers }).body;
    expect(drawn(calibration, { hips: seen })).toEqual(free.body);
    expect(drawn(withOffsets(calibration), { hips: { ...seen!, tracking: 'emulated' } })).toEqual(free.body);
    for (const y of [Number.NaN, Number.POSITIVE_INFINITY, 1e300]) {
      const invalid = { ...seen!, position: { ...seen!.position, y } };
      expect(drawn(withOffsets(calibration), { hips: invalid })).toEqual(free.body);
    }
    const far = trackersOn({ hips: { ...hips, position: add(hips.position, vec3(0.9, 0, 0)) } });
    expect(drawn(withOffsets(calibration), far)).toEqual(free.body);
    expect(drawn(withOffsets(calibration), { hips: null })).toEqual(free.body);
  });

  test('moves no joint by a jump when trackers are lost and found, in any motion', () => {
    fc.assert(
      fc.property(
        fc.integer(),
        standpoint,
        aside,
        turn,
        evenly(0, 60),
        fc.constantFrom<JointName[]>(['hips'], ['chest'], ['hips', 'chest']),
        (motion, place, to, about, start, names) => {
          const person = movingPerson(motion, calibration, place);
          const [plain, pinned] = [createEstimator('ik', calibration), createPinned(calibration)];
          let before: { readonly free: Joints; readonly drawn: Joints } | null = null;
          let furthest = 0;
          for (let i = 0; i < 150; i++) {
            const frame = person(start + i * rate);
            const free = draw(plain, frame);
            const headJoint = headJointIn(frame, calibration);
            const goals = Object.fromEntries(
              names.map((name) => [
                name,
                elsewhere(free[name], to, about, headJoint, reaches(calibration)[name as 'hips']),
              ]),
            ) as TrueJoints;
            const lost = (i >= 40 && i < 80) || (i >= 110 && i < 116);
            const drawn = draw(pinned, lost ? frame : { ...frame, trackers: trackersOn(goals) });
            const joints = ['hips', 'chest', 'neck', 'leftUpperArm', 'rightUpperArm', 'rightLowerArm'] as const;
            for (const joint of before ? joints : []) {
              const own = distance(at(free, joint), at(before!.free, joint));
              const jump = distance(at(drawn, joint), at(before!.drawn, joint)) - own;
              // Near full stretch an elbow goes further than the trunk that it hangs from.
              furthest = Math.max(furthest, joint === 'rightLowerArm' ? jump - 0.01 : jump);
            }
            before = { free, drawn };
          }
          expect(furthest).toBeLessThan(0.05);
        },
      ),
      {
        seed,
        numRuns: cases(30),
        endOnFailure: true,
        // An arm near its full stretch under a trunk that sinks: its elbow made a step of 7 cm.
        examples: [
          [
            -153846204,
            { x: 3, z: -2.08, yaw: -1.87 },
            { x: -1, y: 0.63, z: -1 },
            { x: -0.057, y: -0.5, z: 0.213 },
            60,
            ['hips', 'chest'],
          ],
        ],
      },
    );
  });

  test('moves no further than its trackers do, however they contradict each other and the head', {
    tags: ['full'],
  }, () => {
    // Each joint moves at most twice as far as a tracker or the head, and at 1.5 m/s besides: a trunk that is straight
    // or folded has joints that have to get round.
    const [factor, speed] = [2, 1.5];
    fc.assert(
      fc.property(fc.integer(), standpoint, evenly(0, 0.12), evenly(0.05, 1), (motion, place, far, pace) => {
        const random = createRandom(motion);
        const person = movingPerson(motion, calibration, place);
        const wander = { hips: wandering(random, far), chest: wandering(random, far) };
        const [plain, pinned] = [createEstimator('ik', calibration), createPinned(calibration)];
        let before: { readonly goals: Goals; readonly head: Vec3; readonly drawn: Joints } | null = null;
        for (let i = 0; i < 150; i++) {
          const frame = { ...person(i * rate * pace), time: i * rate };
          const free = draw(plain, frame);
          const goals = {
            hips: wander.hips(free.hips, i * rate * pace),
            chest: wander.chest(free.chest, i * rate * pace),
          };
          const drawn = draw(pinned, { ...frame, trackers: trackersOn(goals) });
          expectWhole(drawn, calibration);
          if (before) {
            const input = Math.max(
              distance(at(free, 'head'), before.head),
              ...(['hips', 'chest'] as const).map((name) => movedBetween(before!.goals[name], goals[name])),
            );
            for (const joint of ['hips', 'spine', 'chest', 'neck'] as const) {
              const step = distance(at(drawn, joint), at(before.drawn, joint));
              expect(step - factor * input, joint).toBeLessThan(speed * rate);
            }
          }
          before = { goals, head: { ...at(free, 'head') }, drawn };
        }
      }),
      { seed, numRuns: cases(20), endOnFailure: true },
    );
  });

  test.each([
    [
      'hips',
      vec3(0, -0.12, 0),
      /^The hips tracker is 1[0-3] cm further from the head than this body’s trunk reaches\./,
    ],
    ['hips', vec3(0.9, 0, 0), /^The hips tracker is 90 cm further from the head/],
    [
      'chest',
      vec3(0, 0.1, 0),
      /^The chest tracker is ([5-9]|10) cm from where head and hips leave this body’s chest\./,
    ],
    [
      'leftFoot',
      vec3(0, -0.15, 0),
      /^The left foot tracker is \d+ cm further from the hips than this body’s leg reaches/,
    ],
  ] as const)('reports a %s tracker that it does not reach for a second, once', (name, by, sentence) => {
    const reports: TrackerMismatch[] = [];
    const watched = { pinning: pinning.reportingTo((mismatch) => reports.push(mismatch)) };
    const estimator = createEstimator('ik', withOffsets(calibration), null, watched);
    const frame = movingPerson(4, calibration, { x: 1, z: 2, yaw: 0.4 })(3);
    const { hips, chest } = draw(createEstimator('ik', calibration), frame);
    const { x, z } = hips.position;
    const leftFoot = { position: vec3(x, hips.position.y - 0.59 * calibration.eyeHeight, z), orientation: identity };
    const trueJoints = { hips, chest, leftFoot };
    const away = { ...trueJoints, [name]: { ...trueJoints[name], position: add(trueJoints[name].position, by) } };
    const show = (from: number, to: number, joints: TrueJoints) => {
      for (let time = from; time < to; time += rate)
        poseOf(estimator, { ...frame, time, trackers: trackersOn(joints) });
    };
    show(0, 2, trueJoints);
    show(2, 2.9, away);
    expect(reports).toEqual([]);
    show(2.9, 5, away);
    expect(reports.map(({ tracker }) => tracker)).toEqual([name]);
    expect(reports[0]!.message).toMatch(sentence);
    expect(reports[0]!.message).toMatch(/Calibrate, or check where it is worn\.$/);
    expect(reports[0]!.far).toBeGreaterThan(0.05);
    show(5, 6, trueJoints);
    show(6, 8, away);
    expect(reports).toHaveLength(2);
  });

  test('is the estimate again when its trackers have been lost for 0.3 s', () => {
    const person = movingPerson(11, calibration, { x: 0, z: 0, yaw: 0 });
    const [plain, pinned] = [createEstimator('ik', calibration), createPinned(calibration)];
    for (let i = 0; i < 60; i++) {
      const frame = person(i * rate);
      const free = poseOf(plain, frame);
      const { hips } = forwardKinematics(skeletonFromCalibration(calibration), free.body!);
      const goal = { ...hips, position: add(hips.position, vec3(0.03, 0.02, 0)) };
      const drawn = poseOf(pinned, i < 30 ? { ...frame, trackers: trackersOn({ hips: goal }) } : frame);
      if (i >= 30 + 19) expect(drawn.body).toEqual(free.body);
    }
  });

  test('is refused with a sentence where a page has not asked for it', () => {
    const frame = movingPerson(3, calibration, { x: 0, z: 0, yaw: 0 })(1);
    const estimator = createEstimator('ik', withOffsets(calibration));
    expect(() => estimator.update({ ...frame, trackers: { hips: null } })).toThrow(/pinning.*threepoint\/trackers/);
    expect(estimator.update(frame).pose.body).not.toBeNull();
  });

  test('takes a tracker without a tracking state, and a rotation of another length, as a hand', () => {
    const frame = movingPerson(4, calibration, { x: 1, z: 2, yaw: 0.4 })(3);
    const { hips } = jointsOf(poseOf(createEstimator('ik', calibration), frame), calibration);
    const goal = { ...hips, position: add(hips.position, vec3(0.02, 0.01, 0)) };
    const { position, orientation } = trackersOn({ hips: goal }).hips!;
    const { x, y, z, w } = orientation;
    // reason: a page without types leaves the state out
    const plain = { position, orientation: { x: 2 * x, y: 2 * y, z: 2 * z, w: 2 * w } } as TrackedPose;
    const joints = jointsOf(poseOf(createPinned(calibration), { ...frame, trackers: { hips: plain } }), calibration);
    expect(distance(at(joints, 'hips'), goal.position)).toBeLessThan(1e-3);
  });

  test.each([
    ['without a rotation', { hips: { position: zero } }, /tracker “hips” is not a pose/],
    [
      'longer than a tracker is worn',
      { chest: { ...trackerAtJoint, position: vec3(0, 0.5, 0) } },
      /“chest” .* 0\.40 m/,
    ],
  ])('refuses an offset %s', (_, offsets, sentence) => {
    // reason: a page without types may leave parts of an offset out
    const body = { ...calibration, trackerOffsets: offsets as TrackerOffsets };
    expect(() => pinning.assertOffsets(body)).toThrow(sentence);
    expect(() => pinning.assertOffsets(withOffsets(calibration))).not.toThrow();
  });

  test('reports the ankles of tracked feet, and none without', () => {
    const frame = movingPerson(2, calibration, { x: 0, z: 0, yaw: 0 })(1);
    const left = { position: vec3(-0.1, 0.09, 0), orientation: fromEulerYxz(vec3(0, 0.2, 0)) };
    const estimator = createPinned(calibration);
    const { feet } = poseOf(estimator, { ...frame, trackers: trackersOn({ leftFoot: left }) });
    expect(distance(feet!.left!.position, left.position)).toBeLessThan(1e-9);
    expect(feet!.left!.orientation).toBeSameRotationAs(left.orientation);
    expect(feet!.right).toBeNull();
    expect(poseOf(estimator, { ...frame, time: frame.time + rate }).feet).toBeUndefined();
  });
});
