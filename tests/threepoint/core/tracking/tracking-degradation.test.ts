import fc from 'fast-check';
import { lerpHandShape, TrackingDegradation, type TrackingFrame } from 'threepoint/core';
import {
  add,
  angleBetween,
  distance,
  fromAxisAngle,
  multiply,
  rotate,
  type TrackedPose,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { closedHand, relaxedHand } from '../../../../src/threepoint/core/body/hand-shape';
import { deviceBodySize } from '../../../../src/threepoint/core/tracking/device-body';
import type { DegradationSettings } from '../../../../src/threepoint/core/tracking/tracking-degradation';
import { evenly, seed } from '../arbitraries';

/** A person who stands turned and swings head and hands; where they are at any time [s]. */
function swinging(time: number, offset: number): TrackedPose {
  const turned = fromAxisAngle(vec3(0, 1, 0), 2.1);
  const bent = fromAxisAngle(vec3(1, 0, 0), 0.8 * Math.sin(2 * time + offset));
  return {
    position: vec3(offset + 0.3 * Math.sin(3 * time), 1.2 + 0.2 * Math.cos(2 * time + offset), -0.4),
    orientation: multiply(turned, bent),
    tracking: 'tracked',
  };
}

const frameAt = (time: number): TrackingFrame => ({
  time,
  head: swinging(time, 0.1),
  leftHand: swinging(time, 0.7),
  rightHand: swinging(time, 1.3),
});

/** Frames of a device of so many Hz, each up to a third of a frame late, as this tracking has them; a copy of each. */
function followed(settings: DegradationSettings, seconds: number, rateHz = 72, of = 7): readonly TrackingFrame[] {
  const tracking = new TrackingDegradation();
  tracking.configure(settings, of);
  return Array.from({ length: seconds * rateHz }, (_, index) => {
    const time = 50 + (index + (index % 4) / 12) / rateHz;
    return structuredClone(tracking.apply(frameAt(time)));
  });
}

const parts = ['head', 'leftHand', 'rightHand'] as const;

describe('the view of a headset’s cameras', () => {
  const gaze = fromAxisAngle(vec3(0, 1, 0), 2.1);
  /** A frame of a head that looks straight ahead, with a hand at a place in its frame [m]. */
  const withHand = (place: Vec3): TrackingFrame => {
    const at = (position: Vec3): TrackedPose => ({ position, orientation: gaze, tracking: 'tracked' });
    const head = at(vec3(1, 1.6, -2));
    return { time: 3, head, leftHand: null, rightHand: at(add(head.position, rotate(gaze, place))) };
  };
  const seen = (place: Vec3): boolean => {
    const tracking = new TrackingDegradation();
    tracking.configure({ cameraView: true });
    return tracking.apply(withHand(place)).rightHand !== null;
  };

  test.each([
    ['before the chest', 0.2, -0.3, -0.4],
    ['raised to the side', 0.5, 0.1, -0.2],
  ])('has a hand %s', (_, x, y, z) => {
    expect(seen(vec3(x, y, z))).toBe(true);
  });

  test.each([
    ['beside the hip', 0.2, -0.85, 0],
    ['above the head', 0.1, 0.5, 0],
    ['behind the back', 0, -0.4, 0.3],
    ['at the face', 0, -0.05, -0.06],
    ['stretched out beyond its range', 0, -0.1, -0.8],
  ])('lacks a hand %s', (_, x, y, z) => {
    expect(seen(vec3(x, y, z))).toBe(false);
  });
});

describe('an added latency', () => {
  test.each([0, 13, 100, 200])('by %i ms shows head and hands as they were then, at any frame rate', (latencyMs) => {
    fc.assert(
      fc.property(evenly(60, 240), (rateHz) => {
        for (const frame of followed({ latencyMs }, 1, Math.round(rateHz)).slice(Math.round(rateHz / 2))) {
          const then = frameAt(frame.time - latencyMs / 1000);
          for (const part of parts) {
            const [is, was] = [frame[part] as TrackedPose, then[part] as TrackedPose];
            // Between two frames the way is taken for straight.
            expect(1000 * distance(is.position, was.position)).toBeLessThan(0.2);
            expect(angleBetween(is.orientation, was.orientation)).toBeLessThan(0.001);
          }
        }
      }),
      { seed, numRuns: 12 },
    );
  });

  test('leaves the time of the frame, so that estimators see every one', () => {
    const times = followed({ latencyMs: 100 }, 1).map(({ time }) => time);
    expect(times).toEqual(followed({}, 1).map(({ time }) => time));
  });

  test('holds the first pose until there is an older one, also after a jump', () => {
    const tracking = new TrackingDegradation();
    tracking.configure({ latencyMs: 100 });
    for (const time of [1, 1.02, 1.04]) expect(tracking.apply(frameAt(time)).head).toMatchObject(frameAt(1).head);
    tracking.reset();
    expect(tracking.apply(frameAt(1.06)).head).toMatchObject(frameAt(1.06).head);
  });

  test('loses a hand, finds it and bends its fingers as much later', () => {
    const tracking = new TrackingDegradation();
    tracking.configure({ latencyMs: 50 });
    const shapes = [0, 0.25, 0.5, 0.75, 1].map((share) => lerpHandShape(relaxedHand, closedHand, share));
    const seen = shapes.map((shape, index) => {
      const time = 3 + index * 0.05;
      const leftHand = index === 1 ? null : swinging(time, 0.7);
      const fingers = { left: index === 1 ? null : shape, right: null };
      return structuredClone(tracking.apply({ ...frameAt(time), leftHand, fingers }));
    });
    expect(seen.map(({ leftHand }) => leftHand !== null)).toEqual([true, true, false, true, true]);
    expect(seen[4]?.fingers?.left?.index.knuckle).toBeCloseTo(shapes[3]?.index.knuckle ?? 0, 6);
    expect(seen[2]?.fingers?.left).toBeNull();
    // A device without fingers says nothing of them, then as now.
    expect(tracking.apply(frameAt(3.25)).fingers).toBeDefined();
    expect(tracking.apply(frameAt(3.3)).fingers).toBeUndefined();
  });
});

describe('a body of the device’s own', () => {
  /** Every joint so many metres along each axis as it is late. */
  const bodyAt = (time: number) => new Float32Array(deviceBodySize).fill(time);
  const followBodies = (settings: DegradationSettings, times: readonly number[]) => {
    const tracking = new TrackingDegradation();
    tracking.configure(settings);
    // In memory that the device overwrites.
    const deviceBody = new Float32Array(deviceBodySize);
    return times.map((time) => {
      deviceBody.set(bodyAt(time));
      return structuredClone(tracking.apply({ ...frameAt(time), ...(time < 4 && { deviceBody }) }));
    });
  };

  test('is as late as head and hands, and gone as late', () => {
    const times = [3.8, 3.85, 3.9, 3.95, 4, 4.05, 4.1, 4.15];
    const heard = followBodies({ latencyMs: 75 }, times).map(({ deviceBody }) => deviceBody?.[7] ?? null);
    const late = [3.8, 3.8, 3.825, 3.875, 3.925, 3.95, null, null];
    expect(heard).toEqual(late.map((time) => time && expect.closeTo(time, 5)));
  });

  test('is left as it is by noise and dropouts, which are of head and hands', () => {
    const settings = {
      trackerNoise: { positionMm: 20, rotationDegrees: 5 },
      dropouts: { perMinute: 60, seconds: 1 },
    };
    const times = [3, 3.1, 3.2];
    expect(followBodies(settings, times).map(({ deviceBody }) => deviceBody)).toEqual(times.map(bodyAt));
  });
});

describe('noise of the tracker', () => {
  const spread = (values: readonly number[]) =>
    Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);

  test('has the stated deviation along and about every axis, and no drift', () => {
    const noisy = followed({ trackerNoise: { positionMm: 8, rotationDegrees: 2 } }, 120);
    for (const part of parts) {
      const errors = noisy.map((frame) => {
        const { position, orientation } = frameAt(frame.time)[part] as TrackedPose;
        const is = frame[part] as TrackedPose;
        return {
          x: 1000 * (is.position.x - position.x),
          y: 1000 * (is.position.y - position.y),
          z: 1000 * (is.position.z - position.z),
          angle: (angleBetween(is.orientation, orientation) * 180) / Math.PI,
        };
      });
      for (const axis of ['x', 'y', 'z'] as const) {
        expect(spread(errors.map((error) => error[axis]))).toBeCloseTo(8, 0);
        expect(errors.reduce((sum, error) => sum + error[axis], 0) / errors.length).toBeCloseTo(0, 0);
      }
      // Three axes of 2° each.
      expect(spread(errors.map(({ angle }) => angle))).toBeCloseTo(2 * Math.sqrt(3), 0);
    }
  });

  test('is the same again by the same seed, and another by another', () => {
    const noise = { trackerNoise: { positionMm: 5, rotationDegrees: 0 } };
    expect(followed(noise, 1)).toEqual(followed(noise, 1));
    expect(followed(noise, 1, 72, 8)).not.toEqual(followed(noise, 1));
  });
});

describe('dropouts', () => {
  const dropouts = { perMinute: 12, seconds: 0.5 };
  const lossesOf = (frames: readonly TrackingFrame[], part: 'leftHand' | 'rightHand') => {
    const lengths: number[] = [];
    let since: number | null = null;
    for (const frame of frames) {
      if (frame[part] === null) since ??= frame.time;
      else if (since !== null) {
        lengths.push(frame.time - since);
        since = null;
      }
    }
    return lengths;
  };

  test('take each hand as often as stated, for as long, and the head never', { tags: ['full'] }, () => {
    const minutes = 40;
    const frames = followed({ dropouts }, 60 * minutes, 30);
    expect(frames.every(({ head }) => head !== null)).toBe(true);
    for (const part of ['leftHand', 'rightHand'] as const) {
      const lengths = lossesOf(frames, part);
      // A wait of 5 s on average and a loss of 0.5 s.
      const expected = (60 * minutes) / 5.5;
      expect(Math.abs(lengths.length - expected)).toBeLessThan(3 * Math.sqrt(expected));
      // One that follows at once makes a loss longer; none is shorter.
      expect(Math.min(...lengths)).toBeGreaterThan(0.45);
      expect(lengths.toSorted((a, b) => a - b)[lengths.length >> 1]).toBeCloseTo(0.5, 1);
    }
  });

  test('take the hands one by one', () => {
    const frames = followed({ dropouts }, 600, 30);
    const both = frames.filter(({ leftHand, rightHand }) => leftHand === null && rightHand === null);
    const either = frames.filter(({ leftHand, rightHand }) => leftHand === null || rightHand === null);
    expect(both.length).toBeLessThan(0.3 * either.length);
  });
});

test('without settings a frame goes on as it came', () => {
  const tracking = new TrackingDegradation();
  const frame = frameAt(4);
  expect(tracking.apply(frame)).toBe(frame);
  tracking.configure({ latencyMs: 100 });
  tracking.configure(null);
  expect(tracking.apply(frame)).toBe(frame);
});
