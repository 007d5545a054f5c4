import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import { chestSpaceBody, skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import {
  type CompletedHand,
  completeHands,
  makeCompleteHandsState,
  resetCompleteHands,
} from '../../../../src/threepoint/core/estimation/complete-hands';
import { createIk } from '../../../../src/threepoint/core/estimation/estimators';
import type { TrackedPose } from '../../../../src/threepoint/core/math/pose';
import { copyQuat, fromAxisAngle, identity, multiply, rotate } from '../../../../src/threepoint/core/math/quat';
import { add, copyVec3, distance, length, up, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { evenly, number, seed } from '../arbitraries';
import { poseOf } from './drawn';
import { tracked } from './moving-person';

const calibration = { eyeHeight: 1.6, armSpan: 1.5 };
const body = chestSpaceBody(calibration);
const skeleton = skeletonFromCalibration(calibration);
const armLength = length(skeleton.restOffsets.rightLowerArm) + length(skeleton.restOffsets.rightHand);
const reach = vec3(0.2, 1.3, -0.45);

const frame = (time: number, rightHand: TrackedPose | null, yaw = 0): TrackingFrame => ({
  time,
  head: tracked(vec3(0, 1.6, 0), fromAxisAngle(up, yaw)),
  leftHand: tracked(vec3(-0.2, 1.3, -0.45)),
  rightHand,
});

interface Hands {
  readonly leftHand: CompletedHand;
  readonly rightHand: CompletedHand;
}

const copyHand = (hand: CompletedHand): CompletedHand => ({
  ...hand,
  position: copyVec3(hand.position),
  orientation: copyQuat(hand.orientation),
  goal: { position: copyVec3(hand.goal.position), orientation: copyQuat(hand.goal.orientation) },
});

/** Hands completed frame after frame, to be kept. */
function completer(): { follow(frame: TrackingFrame): Hands; reset(): void } {
  const state = makeCompleteHandsState();
  let last = Number.NaN;
  return {
    follow(frame) {
      const deltaSeconds = Number.isNaN(last) ? 0 : frame.time - last;
      last = frame.time;
      const { leftHand, rightHand } = completeHands(state, frame.head, frame, body, deltaSeconds);
      return { leftHand: copyHand(leftHand), rightHand: copyHand(rightHand) };
    },
    reset() {
      resetCompleteHands(state);
      last = Number.NaN;
    },
  };
}

const timesOf = (seconds: number, rateHz: number): number[] =>
  Array.from({ length: Math.round(seconds * rateHz) + 1 }, (_, i) => i / rateHz);

/** The hands over time: the right one seen before 0, then as `at` says. */
function follow(at: (time: number) => TrackingFrame, seconds: number, rateHz = 60): Hands[] {
  const hands = completer();
  hands.follow(frame(-0.01, tracked(reach)));
  return timesOf(seconds, rateHz).map((time) => hands.follow(at(time)));
}

/** Right shoulder, elbow and wrist as they are drawn. */
interface Arm {
  readonly shoulder: Vec3;
  readonly elbow: Vec3;
  readonly wrist: Vec3;
}

/** The right arm that a whole estimator draws, frame after frame. */
function drawer(): { draw(frame: TrackingFrame): Arm; reset(): void } {
  const estimator = createIk(calibration);
  return {
    draw(frame) {
      const { rightUpperArm, rightLowerArm, rightHand } = forwardKinematics(skeleton, poseOf(estimator, frame).body!);
      return { shoulder: rightUpperArm.position, elbow: rightLowerArm.position, wrist: rightHand.position };
    },
    reset: () => estimator.reset(),
  };
}

/** The drawn arm over time: its hand seen before 0, then as `at` says. */
function drawn(at: (time: number) => TrackingFrame, seconds: number, rateHz = 60): Arm[] {
  const arm = drawer();
  arm.draw(frame(-0.01, tracked(reach)));
  return timesOf(seconds, rateHz).map((time) => arm.draw(at(time)));
}

const largestOf = (places: readonly Vec3[]): number =>
  Math.max(...places.slice(1).map((place, i) => distance(place, places[i]!)));

const largestStep = (frames: readonly Hands[]): number => largestOf(frames.map(({ rightHand }) => rightHand.position));
/** Returns the largest step of wrist and elbow. */
const largestDrawnStep = (arms: readonly Arm[]): number =>
  Math.max(largestOf(arms.map(({ wrist }) => wrist)), largestOf(arms.map(({ elbow }) => elbow)));

const lost = (time: number) => frame(time, null);

describe('a hand that is seen', () => {
  test('is where it is seen', () => {
    const [first] = follow((time) => frame(time, tracked(reach)), 0);
    expect(first!.rightHand).toMatchObject({
      position: reach,
      orientation: identity,
      source: 'tracked',
      confidence: 1,
    });
    expect(first!.rightHand).toMatchObject({ goal: { position: reach, orientation: identity }, jumped: false });
    expect(first!.leftHand.source).toBe('tracked');
  });
});

describe('a hand that is lost', () => {
  test('is held at first: most losses are short', () => {
    const frames = follow(lost, 0.1);
    for (const { rightHand } of frames) {
      expect(rightHand.source).not.toBe('tracked');
      expect(distance(rightHand.position, reach)).toBeLessThan(1e-3);
    }
  });

  test('sinks slowly, and rests beside the hip after two and a half seconds, without a jump', () => {
    const frames = follow(lost, 4);
    const rest = frames.at(-1)!.rightHand.position;
    expect(rest.y).toBeGreaterThan(0.6);
    expect(rest.y).toBeLessThan(0.95);
    expect(rest.x).toBeGreaterThan(0.15);
    expect(Math.abs(rest.z)).toBeLessThan(0.2);
    expect(distance(frames[30]!.rightHand.position, reach)).toBeLessThan(0.15);
    expect(distance(frames[160]!.rightHand.position, rest)).toBeLessThan(0.01);
    expect(largestStep(frames)).toBeLessThan(0.05);
  });

  test('is not swung around by a head that glances aside', () => {
    const frames = follow((time) => frame(time, null, 0.6), 0.1);
    for (const { rightHand } of frames) expect(distance(rightHand.position, reach)).toBeLessThan(0.06);
  });

  test('turns with a person who turns around meanwhile', () => {
    const turning = (time: number) => Math.min(3 * time, Math.PI);
    const { rightHand } = follow((time) => frame(time, null, turning(time)), 3).at(-1)!;
    // Facing +Z, the right hand rests at −X.
    expect(rightHand.position.x).toBeLessThan(-0.15);
  });

  test('stays calm when the head on its side has no heading to speak of', () => {
    const onItsSide = (yaw: number) =>
      multiply(fromAxisAngle(up, yaw), fromAxisAngle(vec3(0, 0, -1), Math.PI / 2 - 0.02));
    const tilted = (time: number): TrackingFrame => ({
      ...frame(time, null),
      head: tracked(vec3(0, 1.2, 0), onItsSide(Math.round(time * 60) % 2 ? 0.4 : 2.5)),
    });
    const frames = follow((time) => (time < 0.5 ? frame(time, null) : tilted(time)), 1.5).slice(31);
    const turnedAway = frames.map((f) => Math.atan2(f.rightHand.position.z, f.rightHand.position.x));
    // The head joint's own way about its eyes remains.
    expect(Math.max(...turnedAway) - Math.min(...turnedAway)).toBeLessThan(0.8);
  });

  test('swings about its shoulder, not through it', () => {
    const behind = vec3(0.1, 1.9, 0.1);
    const hands = completer();
    hands.follow(frame(-0.01, tracked(behind)));
    for (let i = 0; i < 90; i++) {
      const { rightHand } = hands.follow(lost(i / 60));
      expect(distance(rightHand.position, vec3(0.18, 1.33, 0.08))).toBeGreaterThan(0.3);
    }
  });

  test('strays no further from its shoulder on its way to rest than at either end', () => {
    const where = fc.record({ x: evenly(-0.4, 0.5), y: evenly(0.7, 1.9), z: evenly(-0.5, 0.4) });
    const shoulder = vec3(0.18, 1.33, 0.08);
    fc.assert(
      fc.property(where, (from) => {
        const hands = completer();
        hands.follow(frame(0, tracked(from)));
        const places = Array.from({ length: 180 }, (_, i) =>
          distance(hands.follow(frame((i + 1) / 60, null)).rightHand.position, shoulder),
        );
        // The shoulder of the test is near that of the code, not the same.
        expect(Math.max(...places)).toBeLessThan(Math.max(distance(from, shoulder), places.at(-1)!) + 0.05);
      }),
      { seed },
    );
  });

  test('is trusted as long as it is held, not at all when it rests', () => {
    const confidence = follow(lost, 1).map(({ rightHand }) => rightHand.confidence);
    expect(confidence.slice(0, 6).every((share) => share === 1)).toBe(true);
    expect(confidence.at(-1)).toBe(0);
    for (let i = 1; i < confidence.length; i++) expect(confidence[i]).toBeLessThanOrEqual(confidence[i - 1]!);
  });

  test('belongs where it was held, then beside the hip: its goal jumps once only', () => {
    const hands = follow(lost, 1).map(({ rightHand }) => rightHand);
    expect(hands.slice(0, 6).every(({ source }) => source === 'held')).toBe(true);
    expect(distance(hands[5]!.goal.position, reach)).toBeLessThan(1e-3);
    expect(hands.slice(7).every(({ source, goal }) => source === 'sinking' && goal.position.y < 1)).toBe(true);
    const jumps = hands.flatMap(({ jumped }, i) => (jumped ? [i] : []));
    expect(jumps).toEqual([hands.findIndex(({ source }) => source === 'sinking')]);
  });

  test('does the same at 60, 72 and 120 Hz', () => {
    const at60 = follow(lost, 0.25, 60).at(-1)!.rightHand.position;
    for (const rate of [72, 120]) {
      // The hold begins with the first frame that misses the hand, which is the same in each.
      expect(distance(follow(lost, 0.25, rate).at(-1)!.rightHand.position, at60)).toBeLessThan(1e-6);
    }
  });

  test('a guessed position is not used', () => {
    const guessed = (time: number) => frame(time, { ...tracked(vec3(0, 0, 0)), tracking: 'emulated' as const });
    const frames = follow(guessed, 1);
    for (const { rightHand } of frames) {
      expect(rightHand.source).not.toBe('tracked');
      expect(rightHand.position.y).toBeGreaterThan(0.5);
    }
    expect(largestStep(frames)).toBeLessThan(0.05);
  });
});

describe('a hand that returns', () => {
  const returned = vec3(0.25, 1.35, -0.4);
  const lostFor =
    (seconds: number, back = returned) =>
    (time: number) =>
      frame(time, time < seconds ? null : tracked(back, fromAxisAngle(up, 1)));

  test('is where it is seen from the first frame on, which alone says that it jumped', () => {
    const hands = follow(lostFor(1), 1.5).map(({ rightHand }) => rightHand);
    for (const hand of hands.slice(60)) {
      expect(hand).toMatchObject({ position: returned, orientation: fromAxisAngle(up, 1), source: 'tracked' });
    }
    for (const { goal } of hands.slice(60)) expect(goal.position).toEqual(returned);
    expect(
      hands
        .slice(55)
        .map(({ jumped }) => jumped)
        .indexOf(true),
    ).toBe(5);
    expect(hands.slice(55).filter(({ jumped }) => jumped)).toHaveLength(1);
  });

  test('is trusted again little by little, within half a second', () => {
    const confidence = follow(lostFor(1), 1.5).map(({ rightHand }) => rightHand.confidence);
    expect(confidence[59]).toBe(0);
    expect(confidence[60]).toBeLessThan(0.1);
    for (let i = 60; i < confidence.length; i++) {
      expect(confidence[i]! - confidence[i - 1]!).toBeLessThan(0.1);
      expect(confidence[i]).toBeGreaterThanOrEqual(confidence[i - 1]!);
    }
    expect(confidence.at(-1)).toBe(1);
  });

  test('is drawn there within 200 ms when it was not far', () => {
    const near = add(reach, vec3(0.1, 0.05, 0));
    // It is seen again in the frame at 0.1 s.
    const arms = drawn(lostFor(0.1, near), 0.3);
    expect(distance(arms.at(-1)!.wrist, near)).toBeLessThan(1e-6);
  });

  test('follows its own movement while its arm is on the way', () => {
    const moving = (time: number) =>
      frame(time, time < 0.05 ? null : tracked(add(reach, vec3(0, 0, -0.05 * Math.sin(10 * time)))));
    const arms = drawn(moving, 0.6);
    expect(largestDrawnStep(arms)).toBeLessThan(0.05);
    expect(distance(arms.at(-1)!.wrist, add(reach, vec3(0, 0, -0.05 * Math.sin(6))))).toBeLessThan(1e-6);
  });

  test('goes on and sinks without a jump when lost again while its arm moves', () => {
    const twice = (time: number) => frame(time, time > 0.5 && time < 0.6 ? tracked(returned) : null);
    expect(largestDrawnStep(drawn(twice, 1.5))).toBeLessThan(0.05);
  });
});

describe('a hand that comes back far from where it rests', () => {
  const where = fc.record({ x: evenly(-0.5, 0.6), y: evenly(0.6, 2), z: evenly(-0.6, 0.4) });
  // After a hand beyond its arm's reach, in the trunk or behind the back, the trunk leans and turns as well: that is
  // another way than the arm's. Drawn evenly, shoulders themselves step by up to 0.2 m, one of twenty times: the reach
  // that the trunk is given is not yet steady there.
  const inReach = fc
    .record({ x: number(-0.5, 0.6), y: number(0.6, 2), z: number(-0.6, 0.4) })
    .filter(
      ({ x, y, z }) =>
        z < 0 && Math.hypot(x, z) > 0.25 && distance(vec3(x, y, z), vec3(0.18, 1.33, 0.08)) < 0.95 * armLength,
    );
  const turningPerson =
    (yaw: number, turning: number) =>
    (time: number, position: Vec3 | null): TrackingFrame => {
      const turn = fromAxisAngle(up, yaw + turning * time);
      const turned = (place: Vec3): TrackedPose => tracked(rotate(turn, place));
      return {
        time,
        head: tracked(vec3(0, 1.6, 0), turn),
        leftHand: turned(vec3(-0.2, 1.3, -0.45)),
        rightHand: position && turned(position),
      };
    };
  /**
   * What a step [m] has beyond what the turning person does; the head joint it turns about goes 0.1 m round the eyes
   * itself.
   */
  const ownStep = (now: Vec3, before: Vec3, turning: number): number =>
    distance(now, before) -
    Math.abs(turning / 60) * (0.2 + Math.max(Math.hypot(now.x, now.z), Math.hypot(before.x, before.z)));

  test('takes no step of its own over 5 cm while lost, however the person turns', { tags: ['full'] }, () => {
    fc.assert(
      fc.property(where, evenly(-Math.PI, Math.PI), evenly(-6, 6), (from, yaw, turning) => {
        const at = turningPerson(yaw, turning);
        const hands = completer();
        let before = hands.follow(at(0, from)).rightHand.position;
        for (let i = 1; i < 180; i++) {
          const now = hands.follow(at(i / 60, null)).rightHand.position;
          expect(ownStep(now, before, turning)).toBeLessThan(0.05);
          before = now;
        }
      }),
      { seed, numRuns: 200 },
    );
  });

  test('takes no own step over 5 cm anywhere in reach, turning up to 86° a second', {
    tags: ['full'],
  }, () => {
    fc.assert(
      fc.property(inReach, inReach, number(-Math.PI, Math.PI), number(-1.5, 1.5), (from, back, yaw, turning) => {
        const at = turningPerson(yaw, turning);
        const arm = drawer();
        let before = arm.draw(at(0, from));
        for (let i = 1; i < 180; i++) {
          const now = arm.draw(at(i / 60, i < 60 ? null : back));
          expect(ownStep(now.wrist, before.wrist, turning)).toBeLessThan(0.05);
          before = now;
        }
        const seen = rotate(fromAxisAngle(up, yaw + (turning * 179) / 60), back);
        const missing = Math.max(distance(before.shoulder, seen) - armLength, 0);
        expect(distance(before.wrist, seen)).toBeLessThan(missing + 1e-4);
      }),
      { seed, numRuns: 200 },
    );
  });
});

describe('a hand that was never seen', () => {
  test('rests from the first frame, then its arm comes from there', () => {
    const hands = completer();
    const first = hands.follow(frame(0, null)).rightHand;
    expect(first).toMatchObject({ source: 'sinking', confidence: 0 });
    expect(first.position.y).toBeLessThan(1);
    expect(first.position.y).toBeGreaterThan(0.5);
    expect(hands.follow(frame(1 / 60, tracked(reach))).rightHand).toMatchObject({ position: reach, jumped: true });
    const arm = drawer();
    const resting = arm.draw(frame(0, null));
    expect(distance(resting.wrist, first.position)).toBeLessThan(0.05);
    expect(largestDrawnStep([resting, arm.draw(frame(1 / 60, tracked(reach)))])).toBeLessThan(0.05);
  });

  test('after a reset nothing is bridged: seen is where it is seen', () => {
    const hands = completer();
    hands.follow(frame(0, null));
    hands.reset();
    expect(hands.follow(frame(1 / 60, tracked(reach))).rightHand).toMatchObject({ position: reach, jumped: false });
    const arm = drawer();
    arm.draw(frame(0, null));
    arm.reset();
    expect(distance(arm.draw(frame(1 / 60, tracked(reach))).wrist, reach)).toBeLessThan(1e-6);
  });
});
