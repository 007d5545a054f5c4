import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { makeUpperBodyPose } from '../../../../src/threepoint/core/body/avatar-pose';
import type { Calibration } from '../../../../src/threepoint/core/body/calibration';
import { forwardKinematics, type JointPoses } from '../../../../src/threepoint/core/body/forward-kinematics';
import { legProportions } from '../../../../src/threepoint/core/body/leg-proportions';
import { armLength, averageSkeleton, type Skeleton } from '../../../../src/threepoint/core/body/skeleton';
import { trackerNames } from '../../../../src/threepoint/core/body/tracker-offsets';
import { createIk } from '../../../../src/threepoint/core/estimation/estimators';
import { pinning } from '../../../../src/threepoint/core/estimation/pinning';
import { type Frame, type Pose, type TrackedPose, transformPose } from '../../../../src/threepoint/core/math/pose';
import { fromAxisAngle, identity, multiply, type Quat } from '../../../../src/threepoint/core/math/quat';
import { add, distance, right, up, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import {
  type GuidedCalibration,
  initialGuidedCalibration,
  stepGuidedCalibration,
} from '../../../../src/threepoint/core/tracking/guided-calibration';
import type { BodyTrackers, TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { evenly, seed, standpoint } from '../arbitraries';
import { tracked } from '../estimation/moving-person';
import { trackersOn, wornOffsets } from '../estimation/tracked-body';

const atRest = (skeleton: Skeleton): JointPoses =>
  forwardKinematics(skeleton, { ...makeUpperBodyPose(), hipsPosition: skeleton.restOffsets.hips });

/**
 * A person of this body, upright at the origin, with both arms straight along `direction` (right side) from the
 * shoulders.
 */
function stretched(
  calibration: Calibration,
  direction: 'forward' | 'sideways' | 'down and out',
  bentTo = 1,
): Omit<TrackingFrame, 'time'> {
  const skeleton = averageSkeleton(calibration);
  const joints = atRest(skeleton);
  const eyes = add(joints.head.position, skeleton.eyesInHead);
  const moved = vec3(-eyes.x, calibration.eyeHeight - eyes.y, -eyes.z);
  const arm = armLength(calibration) * bentTo;
  const wrist = (side: 'left' | 'right'): TrackedPose => {
    const sigma = side === 'left' ? -1 : 1;
    const shoulder = add(joints[`${side}UpperArm`].position, moved);
    const along = {
      forward: vec3(0, 0, -arm),
      sideways: vec3(sigma * arm, 0, 0),
      'down and out': vec3(sigma * arm * Math.SQRT1_2, -arm * Math.SQRT1_2, 0),
    };
    return tracked(add(shoulder, along[direction]));
  };
  return {
    head: tracked(vec3(0, calibration.eyeHeight, 0)),
    leftHand: wrist('left'),
    rightHand: wrist('right'),
  };
}

/** Two seconds and a bit at 72 Hz. */
function guide(at: (seconds: number) => Omit<TrackingFrame, 'time'>, rateHz = 72): GuidedCalibration {
  let state: GuidedCalibration = initialGuidedCalibration;
  for (let i = 0; i <= 2.1 * rateHz; i++)
    state = stepGuidedCalibration(state, { ...at(i / rateHz), time: 50 + i / rateHz }, pinning);
  return state;
}

const person: Calibration = { eyeHeight: 1.6, armSpan: 1.5 };
const longArmed: Calibration = { eyeHeight: 1.6, armSpan: 1.65 };

/** The measures of a calibration that is done. */
const measured = (state: GuidedCalibration): Calibration => {
  if (state.kind !== 'done') throw new Error(JSON.stringify(state));
  return state.calibration;
};
const refused = (state: GuidedCalibration): string => {
  if (state.kind !== 'failed') throw new Error(`expected a refusal, got ${state.kind}`);
  return state.reason;
};

describe('the guided calibration', () => {
  test.each(['forward', 'sideways', 'down and out'] as const)(
    'finds height and span of who stretches both arms %s',
    (direction) => {
      const bodies = fc
        .tuple(evenly(1, 2.1), evenly(0.88, 1.02))
        .map(([eyeHeight, ratio]) => ({ eyeHeight, armSpan: eyeHeight * ratio }));
      fc.assert(
        fc.property(bodies, standpoint, (calibration, { x, z, yaw }) => {
          const there = { position: vec3(x, 0, z), orientation: fromAxisAngle(up, yaw) };
          const still = stretched(calibration, direction);
          const moved = (p: TrackedPose): TrackedPose => {
            const { position, orientation } = transformPose(there, p as Pose<Frame>);
            return tracked(position, orientation);
          };
          const state = guide(() => ({
            head: moved(still.head),
            leftHand: moved(still.leftHand!),
            rightHand: moved(still.rightHand!),
          }));
          const found = measured(state);
          expect(Math.abs(found.eyeHeight - calibration.eyeHeight)).toBeLessThan(1e-9);
          // Forward, the shoulders come along by a few centimetres, and bodies differ in how far.
          expect(Math.abs(found.armSpan - calibration.armSpan)).toBeLessThan(0.05 * calibration.eyeHeight);
        }),
        { seed },
      );
    },
  );

  test('a wild frame or two does not move the result', () => {
    const still = stretched(person, 'forward');
    const jitter = (seconds: number) => Math.round(seconds * 72) % 24 === 5;
    const jittered = guide((seconds) =>
      jitter(seconds) ? { ...still, head: tracked(vec3(0, 1.63, 0)), rightHand: tracked(vec3(0.6, 1, -0.4)) } : still,
    );
    const { eyeHeight, armSpan } = measured(jittered);
    expect(eyeHeight).toBeCloseTo(1.6, 6);
    expect(armSpan).toBeCloseTo(measured(guide(() => still)).armSpan, 6);
  });

  test('reports how much is done, and ends after two seconds', () => {
    const still = stretched(person, 'forward');
    let state: GuidedCalibration = initialGuidedCalibration;
    const parts: number[] = [];
    for (let i = 0; state.kind === 'measuring'; i++) {
      parts.push(state.part);
      state = stepGuidedCalibration(state, { ...still, time: i / 72 });
    }
    expect(parts).toEqual([...parts].sort((a, b) => a - b));
    expect(parts.length).toBe(2 * 72 + 1);
    expect(stepGuidedCalibration(state, { ...still, time: 99 })).toBe(state);
  });

  test('one hand that is no person’s does not matter', () => {
    const state = guide(() => ({ ...stretched(person, 'forward'), leftHand: null }));
    expect(state.kind).toBe('done');
  });

  test('a hand lost for a moment does not matter either', () => {
    const still = stretched(person, 'forward');
    expect(guide((seconds) => (seconds > 0.5 && seconds < 0.8 ? { ...still, leftHand: null } : still)).kind).toBe(
      'done',
    );
  });

  test.each<[string, (seconds: number) => Omit<TrackingFrame, 'time'>, RegExp]>([
    [
      'the head moved',
      (s) => ({ ...stretched(person, 'forward'), head: tracked(vec3(0.1 * s, 1.6, 0)) }),
      /head moved/,
    ],
    ['no hand was seen', () => ({ ...stretched(person, 'forward'), leftHand: null, rightHand: null }), /not seen/],
    [
      'a hand was guessed by the device half of the time',
      (s) => {
        const still = stretched(person, 'forward');
        return s > 1 ? { ...still, leftHand: { ...still.leftHand!, tracking: 'emulated' } } : still;
      },
      /left hand was not seen/,
    ],
    ['the elbows were bent', () => stretched(person, 'forward', 0.6), /not stretched/],
    [
      'a hand waved',
      (s) => {
        const still = stretched(person, 'forward');
        return { ...still, rightHand: tracked(add(still.rightHand!.position, vec3(0, 0.2 * Math.sin(9 * s), 0))) };
      },
      /hands moved/,
    ],
    [
      'the arms hung down',
      () => ({
        ...stretched(person, 'forward'),
        leftHand: tracked(vec3(-0.2, 0.8, 0)),
        rightHand: tracked(vec3(0.2, 0.8, 0)),
      }),
      /forward/,
    ],
    [
      'one arm was shorter',
      () => ({ ...stretched(longArmed, 'forward'), leftHand: stretched(longArmed, 'forward', 0.82).leftHand }),
      /One arm/,
    ],
    [
      'the eyes were on the floor',
      () => ({
        ...stretched(person, 'forward'),
        head: tracked(vec3(0, 1.6, 0), fromAxisAngle(right, -0.8)),
      }),
      /look/i,
    ],
    ['a tiny person', () => stretched({ eyeHeight: 0.7, armSpan: 0.66 }, 'forward'), /height of 0\.75 m/],
  ])('refuses with a sentence when %s', (_, at, sentence) => {
    expect(refused(guide(at))).toMatch(sentence);
  });

  test.each([0.45, 0.55, 0.7])('a person who sits, or stands %d m low, is as tall as their arms say', (lower) => {
    const still = stretched(person, 'forward');
    const sunk = (p: TrackedPose | null) => p && tracked(add(p.position, vec3(0, -lower, 0)));
    const state = guide(() => ({
      head: sunk(still.head)!,
      leftHand: sunk(still.leftHand),
      rightHand: sunk(still.rightHand),
    }));
    const { eyeHeight, armSpan } = measured(state);
    expect(Math.abs(eyeHeight - person.eyeHeight)).toBeLessThan(0.15);
    expect(Math.abs(armSpan - person.armSpan)).toBeLessThan(0.1);
  });

  test('refuses when tracking was gone for most of the time', () => {
    const still = stretched(person, 'forward');
    let state: GuidedCalibration = initialGuidedCalibration;
    for (const time of [0, 0.01, 0.02, 6.5]) state = stepGuidedCalibration(state, { ...still, time });
    expect(refused(state)).toMatch(/Tracking was lost/);
  });

  test('takes its time where frames come three times a second', () => {
    const still = stretched(person, 'forward');
    let state: GuidedCalibration = initialGuidedCalibration;
    for (let frame = 0; frame <= 6; frame++) state = stepGuidedCalibration(state, { ...still, time: frame / 3 });
    expect(state).toMatchObject({ kind: 'measuring', part: 1 });
    state = stepGuidedCalibration(state, { ...still, time: 7 / 3 });
    expect(state.kind).toBe('done');
  });

  test('the measured arms are as long as the way from the shoulder to the wrist', () => {
    const { armSpan } = measured(guide(() => stretched(person, 'sideways')));
    expect(stretched(person, 'sideways').rightHand!.position.x).toBeCloseTo(armSpan / 2, 2);
  });

  describe('the tilt of the headset', () => {
    const worn = (pitch: number, yaw = 0, direction: 'forward' | 'sideways' | 'down and out' = 'forward') => {
      const still = stretched(person, direction);
      const turn = multiply(fromAxisAngle(up, yaw), fromAxisAngle(right, pitch));
      return measured(guide(() => ({ ...still, head: { ...still.head, orientation: turn } })));
    };

    test('is what it shows while its wearer looks where the arms point', () => {
      for (const pitch of [-0.2, -0.05, 0.1]) expect(worn(pitch).gazePitch).toBeCloseTo(pitch, 6);
    });

    test.each(['sideways', 'down and out'] as const)('is measured with the arms %s', (direction) => {
      expect(worn(0.1, 0.1, direction).gazePitch).toBeCloseTo(0.1, 6);
      expect(worn(0.1, -0.3, direction)).not.toHaveProperty('gazePitch');
    });

    test('is never assumed to be steeper than 15°', () => {
      expect(worn(0.4).gazePitch).toBeCloseTo(Math.PI / 12, 6);
    });

    test('is not measured on a person who reads a sheet beside them', () => {
      expect(worn(-0.2, -0.2)).not.toHaveProperty('gazePitch');
    });
  });

  describe('the offsets of trackers', () => {
    const skeleton = averageSkeleton(person);
    const rest = atRest(skeleton);
    const eyes = add(rest.head.position, skeleton.eyesInHead);
    const underHead = ({ x, y, z }: Vec3) => vec3(x - eyes.x, y + person.eyeHeight - eyes.y, z - eyes.z);
    const hips = underHead(rest.hips.position);
    const ankle = (x: number) => ({
      position: vec3(x, legProportions.ankle * person.eyeHeight, hips.z),
      orientation: identity,
    });
    const joints = {
      hips: { position: hips, orientation: identity },
      chest: { position: underHead(rest.chest.position), orientation: identity },
      leftFoot: ankle(-0.15),
      rightFoot: ankle(0.11),
    };
    const there = { position: vec3(0.7, 0, -1.2), orientation: fromAxisAngle(up, 2.2) };
    const place = ({ position, orientation }: Pose<Frame>): TrackedPose => {
      const moved = transformPose(there, { position, orientation });
      return tracked(moved.position, moved.orientation);
    };
    const still = stretched(person, 'down and out');
    const moved = { head: place(still.head), leftHand: place(still.leftHand!), rightHand: place(still.rightHand!) };
    const worn = trackersOn(joints);
    const placed = Object.fromEntries(
      Object.entries(worn).map(([name, tracker]) => [name, place(tracker!)]),
    ) as Required<BodyTrackers>;

    test('come back as they were worn, wherever the person stands', () => {
      const offsets = measured(guide(() => ({ ...moved, trackers: placed }))).trackerOffsets;
      for (const name of trackerNames) {
        const offset = offsets?.[name];
        expect(offset!.orientation).toBeSameRotationAs(wornOffsets[name].orientation);
        const joint = transformPose<'floor', 'tracker'>(worn[name]!, offset!);
        // An ankle is assumed as far aside as its tracker.
        const foot = name === 'leftFoot' || name === 'rightFoot';
        const wanted = foot ? { ...joints[name].position, x: worn[name]!.position.x } : joints[name].position;
        expect(distance(joint.position, wanted)).toBeLessThan(1e-6);
      }
    });

    test('lead an estimator to the joints of the person who calibrated', () => {
      const estimator = createIk(measured(guide(() => ({ ...moved, trackers: placed }))), { pinning });
      const { body } = estimator.update({ ...moved, time: 0, trackers: placed }).pose;
      expect(distance(body!.hipsPosition, place(joints.hips).position)).toBeLessThan(1e-3);
    });

    test('are refused with a sentence where a page has not asked for them', () => {
      const frame = { ...moved, time: 0, trackers: placed };
      expect(() => stepGuidedCalibration(initialGuidedCalibration, frame)).toThrow(/pinning.*threepoint\/trackers/);
    });

    test('remain unknown for a tracker that moves, is lost or belongs elsewhere', () => {
      const { trackerOffsets } = measured(
        guide((seconds) => ({
          ...moved,
          trackers: {
            hips: { ...placed.hips!, position: add(placed.hips!.position, vec3(0, 0.1 * Math.sin(9 * seconds), 0)) },
            chest: seconds < 1 ? placed.chest : null,
            leftFoot: placed.rightFoot,
            rightFoot: { ...placed.rightFoot!, position: add(placed.rightFoot!.position, vec3(0, 0.6, 0)) },
          },
        })),
      );
      expect(Object.keys(trackerOffsets!)).toEqual(['leftFoot']);
    });

    test('remain unknown for the feet where the person sits', () => {
      const sunk = (p: TrackedPose) => tracked(add(p.position, vec3(0, -0.5, 0)), p.orientation);
      const sitting = { head: sunk(moved.head), leftHand: sunk(moved.leftHand), rightHand: sunk(moved.rightHand) };
      const hipsTracker = sunk(placed.hips!);
      const { trackerOffsets } = measured(guide(() => ({ ...sitting, trackers: { ...placed, hips: hipsTracker } })));
      expect(trackerOffsets).not.toHaveProperty('leftFoot');
      expect(trackerOffsets).toHaveProperty('hips');
    });
  });

  describe('the tilts of the hands', () => {
    const still = stretched(person, 'forward');
    /** Both hands turned in their own frames while the arms point ahead. */
    const held = (left: Quat, right: Quat) => ({
      ...still,
      leftHand: tracked(still.leftHand!.position, left),
      rightHand: tracked(still.rightHand!.position, right),
    });
    const tiltsOf = (state: GuidedCalibration) => measured(state).handTilts;

    test('are how controllers are held, arms and wrists straight', () => {
      const state = guide(() => held(fromAxisAngle(right, -0.4), fromAxisAngle(up, 0.3)));
      const tilts = tiltsOf(state);
      // The arms point a little inward or outward of straight ahead: the shoulders are the average body's.
      expect(Math.abs((tilts?.left?.pitch ?? 9) - 0.4)).toBeLessThan(0.1);
      expect(Math.abs(tilts?.left?.yaw ?? 9)).toBeLessThan(0.1);
      expect(Math.abs((tilts?.right?.yaw ?? 9) + 0.3)).toBeLessThan(0.1);
      expect(Math.abs(tilts?.right?.pitch ?? 9)).toBeLessThan(0.1);
    });

    test('stay unknown of a wrist that is bent further than any hand is held', () => {
      const tilts = tiltsOf(guide(() => held(fromAxisAngle(right, -1.2), identity)));
      expect(tilts).not.toHaveProperty('left');
      expect(tilts).toHaveProperty('right');
    });

    test('stay unknown of hands that turn meanwhile', () => {
      const state = guide((seconds) => {
        const turning = fromAxisAngle(right, 0.6 * Math.sin(6 * seconds));
        return held(turning, turning);
      });
      expect(tiltsOf(state)).toBeUndefined();
    });

    test('a hand that is not seen has none', () => {
      const state = guide(() => ({ ...held(identity, identity), leftHand: null }));
      expect(Object.keys(tiltsOf(state) ?? {})).toEqual(['right']);
    });
  });
});
