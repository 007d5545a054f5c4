import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { fromAxisAngle, identity, multiply, rotate } from '../../../src/core/math/quat';
import { add, distance, up, type Vec3, vec3 } from '../../../src/core/math/vec3';
import { type ContinuedFrame, createHandContinuity } from '../../../src/core/tracking/hand-continuity';
import type { TrackedPose, TrackingFrame } from '../../../src/core/tracking/tracking-frame';
import { number, seed } from '../arbitraries';

const calibration = { eyeHeight: 1.6, armSpan: 1.5 };
const tracked = (position: Vec3, orientation = identity): TrackedPose => ({
  position,
  orientation,
  tracking: 'tracked',
});
const reach = vec3(0.2, 1.3, -0.45);

const frame = (time: number, rightHand: TrackedPose | null, yaw = 0): TrackingFrame => ({
  time,
  head: tracked(vec3(0, 1.6, 0), fromAxisAngle(up, yaw)),
  leftHand: tracked(vec3(-0.2, 1.3, -0.45)),
  rightHand,
});

/** The right hand over time: seen before 0, then as `at` says. */
function follow(at: (time: number) => TrackingFrame, seconds: number, rateHz = 60): ContinuedFrame[] {
  const continuity = createHandContinuity(() => calibration);
  continuity.follow(frame(-0.01, tracked(reach)));
  return Array.from({ length: Math.round(seconds * rateHz) + 1 }, (_, i) => continuity.follow(at(i / rateHz)));
}

const largestStep = (frames: readonly ContinuedFrame[]): number =>
  Math.max(...frames.slice(1).map((f, i) => distance(f.rightHand.position, frames[i]!.rightHand.position)));

const lost = (time: number) => frame(time, null);

describe('a hand that is seen', () => {
  test('is where it is seen', () => {
    const [first] = follow((time) => frame(time, tracked(reach)), 0);
    expect(first!.rightHand).toMatchObject({ position: reach, orientation: identity, seen: true, trust: 1 });
    expect(first!.rightHand.way).toMatchObject({ goal: { position: reach, orientation: identity }, rests: false });
    expect(first!.leftHand.seen).toBe(true);
  });
});

describe('a hand that is lost', () => {
  test('is held at first: most losses are short', () => {
    const frames = follow(lost, 0.1);
    for (const { rightHand } of frames) {
      expect(rightHand.seen).toBe(false);
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

  test('turns with somebody who turns around meanwhile', () => {
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
    const continuity = createHandContinuity(() => calibration);
    continuity.follow(frame(-0.01, tracked(behind)));
    for (let i = 0; i < 90; i++) {
      const { rightHand } = continuity.follow(lost(i / 60));
      expect(distance(rightHand.position, vec3(0.18, 1.33, 0.08))).toBeGreaterThan(0.3);
    }
  });

  test('is trusted as long as it is held, not at all when it rests', () => {
    const trust = follow(lost, 1).map(({ rightHand }) => rightHand.trust);
    expect(trust.slice(0, 6).every((share) => share === 1)).toBe(true);
    expect(trust.at(-1)).toBe(0);
    for (let i = 1; i < trust.length; i++) expect(trust[i]).toBeLessThanOrEqual(trust[i - 1]!);
  });

  test('belongs where it was held at first, then beside the hip: that is a new way', () => {
    const ways = follow(lost, 1).map(({ rightHand }) => rightHand.way);
    expect(ways.slice(0, 6).every(({ rests }) => !rests)).toBe(true);
    expect(distance(ways[5]!.goal.position, reach)).toBeLessThan(1e-3);
    expect(ways.slice(7).every(({ rests, goal }) => rests && goal.position.y < 1)).toBe(true);
    expect(new Set(ways.map(({ since }) => since)).size).toBe(2);
    expect(ways.at(-1)!.age).toBeCloseTo(0.9, 6);
  });

  test('does the same at 60, 72 and 120 Hz', () => {
    const at60 = follow(lost, 0.25, 60).at(-1)!.rightHand.position;
    for (const rate of [72, 120]) {
      // The hold begins with the first frame that misses the hand, which is the same in each.
      expect(distance(follow(lost, 0.25, rate).at(-1)!.rightHand.position, at60)).toBeLessThan(1e-6);
    }
  });

  test('a guessed position is not believed', () => {
    const guessed = (time: number) => frame(time, { ...tracked(vec3(0, 0, 0)), tracking: 'emulated' as const });
    const frames = follow(guessed, 1);
    for (const { rightHand } of frames) {
      expect(rightHand.seen).toBe(false);
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

  test.each([0.05, 0.2, 0.35, 1])('blends back after %s s without a jump', (seconds) => {
    const frames = follow(lostFor(seconds), seconds + 1);
    expect(largestStep(frames)).toBeLessThan(0.05);
    const { rightHand } = frames.at(-1)!;
    expect(rightHand).toMatchObject({ position: returned, orientation: fromAxisAngle(up, 1), seen: true, trust: 1 });
  });

  test('is there within 200 ms when it was not far', () => {
    const near = add(reach, vec3(0.1, 0.05, 0));
    const frames = follow(lostFor(0.1, near), 0.35);
    expect(distance(frames.at(-1)!.rightHand.position, near)).toBeLessThan(1e-9);
  });

  test('belongs where it is seen from the first frame on', () => {
    const ways = follow(lostFor(1), 1.5).map(({ rightHand }) => rightHand.way);
    for (const way of ways.slice(60))
      expect(way).toMatchObject({ goal: { position: returned }, rests: false, since: 1 });
  });

  test('never strays further from its shoulder than where it comes from and where it goes', () => {
    const where = fc.record({ x: number(-0.4, 0.5), y: number(0.7, 1.9), z: number(-0.5, 0.4) });
    const shoulder = vec3(0.18, 1.33, 0.08);
    fc.assert(
      fc.property(where, where, (from, back) => {
        const continuity = createHandContinuity(() => calibration);
        continuity.follow(frame(0, tracked(from)));
        const places = Array.from({ length: 60 }, (_, i) =>
          continuity.follow(frame((i + 1) / 60, i < 5 ? null : tracked(back))),
        ).map(({ rightHand }) => distance(rightHand.position, shoulder));
        // The shoulder of the test is near that of the code, not the same.
        expect(Math.max(...places)).toBeLessThan(Math.max(distance(from, shoulder), distance(back, shoulder)) + 0.05);
      }),
      { seed },
    );
  });

  test('follows its own movement while it blends', () => {
    const moving = (time: number) =>
      frame(time, time < 0.05 ? null : tracked(add(reach, vec3(0, 0, -0.5 * time)), multiply(identity, identity)));
    const frames = follow(moving, 0.6);
    expect(largestStep(frames)).toBeLessThan(0.05);
    expect(distance(frames.at(-1)!.rightHand.position, add(reach, vec3(0, 0, -0.3)))).toBeLessThan(1e-9);
  });

  test('lost again on its way back, it sinks from where it is', () => {
    const frames = follow((time) => frame(time, time > 0.5 && time < 0.6 ? tracked(returned) : null), 1.5);
    expect(largestStep(frames)).toBeLessThan(0.05);
  });
});

describe('a hand that comes back far from where it rests', () => {
  test('takes no step of its own over 5 cm, wherever it comes back and however the person turns', () => {
    const where = fc.record({ x: number(-0.5, 0.6), y: number(0.6, 2), z: number(-0.6, 0.4) });
    fc.assert(
      fc.property(where, where, number(-Math.PI, Math.PI), number(-6, 6), (from, back, yaw, turning) => {
        const at = (time: number, position: Vec3 | null): TrackingFrame => {
          const turn = fromAxisAngle(up, yaw + turning * time);
          return { ...frame(time, position && tracked(rotate(turn, position))), head: tracked(vec3(0, 1.6, 0), turn) };
        };
        const continuity = createHandContinuity(() => calibration);
        let before = continuity.follow(at(0, from)).rightHand.position;
        for (let i = 1; i < 180; i++) {
          const now = continuity.follow(at(i / 60, i < 60 ? null : back)).rightHand.position;
          // What the turning person does is no step of the hand's own; the head joint it turns about goes 0.1 m round the eyes itself.
          const radius = 0.2 + Math.max(Math.hypot(now.x, now.z), Math.hypot(before.x, before.z));
          const own = distance(now, before) - Math.abs(turning / 60) * radius;
          expect(own).toBeLessThan(0.05);
          before = now;
        }
        expect(distance(before, rotate(fromAxisAngle(up, yaw + (turning * 179) / 60), back))).toBeLessThan(1e-9);
      }),
      { seed, numRuns: 200 },
    );
  });
});

describe('a hand that was never seen', () => {
  test('rests from the first frame, then comes from there', () => {
    const continuity = createHandContinuity(() => calibration);
    const first = continuity.follow(frame(0, null)).rightHand;
    expect(first.position.y).toBeLessThan(1);
    expect(first.position.y).toBeGreaterThan(0.5);
    const next = continuity.follow(frame(1 / 60, tracked(reach))).rightHand;
    expect(distance(next.position, first.position)).toBeLessThan(0.05);
  });

  test('after a reset nothing is bridged: seen is where it is seen', () => {
    const continuity = createHandContinuity(() => calibration);
    continuity.follow(frame(0, null));
    continuity.reset();
    expect(continuity.follow(frame(1 / 60, tracked(reach))).rightHand.position).toEqual(reach);
  });
});
