import fc from 'fast-check';
import {
  parseRecording,
  type Recording,
  recordingDuration,
  sampleRecording,
  type TrackingFrame,
  writeRecording,
  writeRecordingWithin,
} from 'threepoint/core';
import { distance, lerp, slerp, type TrackedPose, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { flatHand } from '../../../../src/threepoint/core/body/hand-shape';
import { deviceBodySize } from '../../../../src/threepoint/core/tracking/device-body';
import { evenly, number, rotation, seed, vector } from '../arbitraries';

const tracked: fc.Arbitrary<TrackedPose> = fc.record({
  position: vector(10),
  orientation: rotation,
  tracking: fc.constantFrom<TrackedPose['tracking'][]>('tracked', 'emulated'),
});

/** An angle as a file has it: to a ten-thousandth of a radian. */
const angle = fc.integer({ min: -4000, max: 12_000 }).map((steps) => steps / 1e4);
const bend = fc.record({ knuckle: angle, spread: angle, middle: angle, end: angle });
const hand = fc.record({
  thumb: bend,
  index: bend,
  middle: bend,
  ring: bend,
  little: bend,
  pinch: fc.integer({ min: 0, max: 10_000 }).map((steps) => steps / 1e4),
});

const tilt = fc.record({ pitch: evenly(-1, 1), yaw: evenly(-1, 1) });

/** A device's joints as a file has them: to a tenth of a millimetre. */
const deviceBody = fc
  .array(fc.integer({ min: -50_000, max: 50_000 }), { minLength: deviceBodySize, maxLength: deviceBodySize })
  .map((steps) => Float32Array.from(steps, (step) => step / 1e4));

const recording: fc.Arbitrary<Recording> = fc.record({
  device: fc.string(),
  rateHz: number(1, 144),
  calibration: fc.option(
    fc.record(
      {
        eyeHeight: number(0.9, 2.2),
        armSpan: number(0.6, 2.3),
        forearm: number(0.2, 0.3),
        gazePitch: evenly(-0.2, 0.2),
        handTilts: fc.record({ left: tilt, right: tilt }, { requiredKeys: ['left'] }),
        gripOffsets: fc.constant({ 'valve-index': { right: { ahead: 0.01, roll: -0.1 } } }),
      },
      { requiredKeys: ['eyeHeight', 'armSpan'] },
    ),
  ),
  frames: fc
    .array(
      fc.record({
        step: number(1e-3, 0.5),
        head: tracked,
        leftHand: fc.option(tracked),
        rightHand: fc.option(tracked),
        fingers: fc.option(fc.record({ left: fc.option(hand), right: fc.option(hand) }), { nil: undefined }),
        deviceBody: fc.option(deviceBody, { nil: undefined }),
      }),
      { minLength: 1, maxLength: 8 },
    )
    .map((frames) => {
      let time = 1000 / 3;
      return frames.map(({ step, ...frame }): TrackingFrame => {
        time += step;
        const { fingers, deviceBody, ...poses } = frame;
        // Frames with a body have a place for fingers, which may be empty.
        const known = fingers ?? (deviceBody && { left: null, right: null });
        return { time, ...poses, ...(known && { fingers: known }), ...(deviceBody && { deviceBody }) };
      });
    }),
});

/** JSON knows no −0; no one's hand does either. */
const withoutNegativeZero = (value: unknown): unknown =>
  typeof value === 'number'
    ? value + 0
    : typeof value === 'object' && value !== null && !ArrayBuffer.isView(value)
      ? Array.isArray(value)
        ? value.map(withoutNegativeZero)
        : Object.fromEntries(Object.entries(value).map(([key, part]) => [key, withoutNegativeZero(part)]))
      : value;

const some: Recording = {
  device: 'a headset',
  rateHz: 72,
  calibration: null,
  frames: [0, 1, 2, 3].map((i) => ({
    time: 5 + i / 10,
    head: { position: vec3(i, 1.6, 0), orientation: { x: 0, y: 0, z: 0, w: 1 }, tracking: 'tracked' },
    leftHand:
      i === 2 ? null : { position: vec3(0, i, 0), orientation: { x: 0, y: 0, z: 0, w: 1 }, tracking: 'tracked' },
    rightHand: null,
  })),
};

/** One frame of a left hand that pinches half, and a right hand whose fingers are not seen. */
const withFingers = writeRecording({
  ...some,
  frames: [{ ...some.frames[0]!, fingers: { left: { ...flatHand, pinch: 0.5 }, right: null } }],
});

/** One frame of a body whose joints all lie in one point. */
const withBody = writeRecording({
  ...some,
  frames: [{ ...some.frames[0]!, deviceBody: new Float32Array(deviceBodySize) }],
});

describe('a recording', () => {
  test('comes back from its file to the last bit, lost hands as null', () => {
    fc.assert(
      fc.property(recording, (recording) => {
        expect(parseRecording(writeRecording(recording))).toEqual(withoutNegativeZero(recording));
      }),
      { seed },
    );
  });

  test('is JSON with a frame per line', () => {
    const text = writeRecording(some);
    expect(JSON.parse(text)).toMatchObject({ format: 'threepoint-recording', version: 1, rateHz: 72 });
    expect(text.trimEnd().split('\n').length).toBe(some.frames.length + 2);
  });

  test('keeps its beginning when cut, in the allowed bytes plus a first frame at most', () => {
    fc.assert(
      fc.property(recording, fc.integer({ min: 0, max: 8000 }), (whole, maxBytes) => {
        const { text, frames } = writeRecordingWithin(whole, maxBytes);
        expect(parseRecording(text).frames).toEqual(parseRecording(writeRecording(whole)).frames.slice(0, frames));
        if (frames > 1) expect(new TextEncoder().encode(text).length).toBeLessThanOrEqual(maxBytes);
      }),
      { seed },
    );
  });

  test('gives the device’s body half-way between two frames, and none where one has none', () => {
    const [first, second, third] = some.frames as [TrackingFrame, TrackingFrame, TrackingFrame];
    const body = (value: number) => ({ deviceBody: new Float32Array(deviceBodySize).fill(value) });
    const embodied = { ...some, frames: [{ ...first, ...body(1) }, { ...second, ...body(2) }, third] };
    expect(sampleRecording(embodied, 5.05).deviceBody?.[7]).toBeCloseTo(1.5, 6);
    expect(sampleRecording(embodied, 5.15).deviceBody).toBeUndefined();
  });

  test.each([
    ['fingers that are too few', withFingers.replace(',0.5],', '],'), /Frame 1 .*fingers of the left hand.*21/],
    ['a bend that is no number', withFingers.replace('0.5],', '"bent"],'), /Frame 1 .*fingers of the left hand.*21/],
    [
      'a body that is too short',
      withBody.replace('null,null,[0,', 'null,null,['),
      /Frame 1 .*the body is not 105 finite/,
    ],
    [
      'a body too far away',
      withBody.replace('null,null,[0,', 'null,null,[1e300,'),
      /Frame 1 .*body is more than 1000 m/,
    ],
    [
      'a head too far away',
      writeRecording(some).replace('[5.2,[2,', '[5.2,[1e300,'),
      /Frame 3.*head is more than 1000 m/,
    ],
    ['a body with other joints', withBody.replace('"hips"', '"tail"'), /other joints/],
    ['fingers of one hand alone', withFingers.replace(/,null\](?=\n)/, ']'), /Frame 1 .*is not a time/],
    ['nothing', '', /not valid JSON/],
    ['prose', 'Dear Sir', /not valid JSON/],
    ['other JSON', '{"photos": []}', /not a threepoint recording/],
    ['an array', '[]', /not a threepoint recording/],
    ['a later version', writeRecording(some).replace('"version":1', '"version":7'), /version 7/],
    ['no frames', '{"format":"threepoint-recording","version":1,"device":"","rateHz":60,"frames":[]}', /no frames/],
    ['no rate', writeRecording(some).replace('"rateHz":72', '"rateHz":"often"'), /rate/],
    ['a damaged line', writeRecording(some).replace('[5.1,', '[5.1 oops,'), /line 3 is damaged/],
    ['a cut-off end', writeRecording(some).slice(0, -20), /not valid JSON/],
    ['a frame without a time', writeRecording(some).replace('[5.1,', '["noon",'), /Frame 2 .*time/],
    ['time that runs backwards', writeRecording(some).replace('[5.1,', '[4.1,'), /Frame 2 .*not later/],
    ['a frame without a head', writeRecording(some).replace('[5.2,[2,', '[5.2,null,[2,'), /Frame 3/],
    ['an unknown word', writeRecording(some).replace('"tracked"', '"dreamt"'), /Frame 1 .*head.*dreamt|Frame 1 .*head/],
    [
      'a quaternion of length 2',
      writeRecording(some).replace('0,0,0,1,"tracked"', '0,0,0,2,"tracked"'),
      /Frame 1 .*orientation/,
    ],
    [
      'a half body',
      writeRecording(some).replace('"calibration":null', '"calibration":{"eyeHeight":1.6}'),
      /calibration/,
    ],
  ])('refuses %s in a sentence', (_, text, sentence) => {
    expect(() => parseRecording(text)).toThrow(sentence);
  });
});

describe('sampling', () => {
  test('at a frame’s own time gives that frame', () => {
    fc.assert(
      fc.property(recording, (recording) => {
        for (const frame of recording.frames) expect(sampleRecording(recording, frame.time)).toEqual(frame);
      }),
      { seed },
    );
  });

  test('between two frames lies on the way from one to the other', () => {
    fc.assert(
      fc.property(recording, number(0.01, 0.99), (recording, share) => {
        fc.pre(recording.frames.length > 1);
        const [a, b] = recording.frames as [TrackingFrame, TrackingFrame];
        const sampled = sampleRecording(recording, a.time + share * (b.time - a.time));
        expect(distance(sampled.head.position, lerp(a.head.position, b.head.position, share))).toBeLessThan(1e-6);
        expect(sampled.head.orientation).toBeSameRotationAs(slerp(a.head.orientation, b.head.orientation, share), 1e-4);
      }),
      { seed },
    );
  });

  test('finds its frame however unevenly a device reported', () => {
    const times = fc.uniqueArray(fc.double({ min: 0, max: 100, noNaN: true }), { minLength: 1, maxLength: 60 });
    fc.assert(
      fc.property(times, number(-5, 105), (unsorted, time) => {
        const sorted = unsorted.toSorted((a, b) => a - b);
        const frames = sorted.map((at) => ({ ...some.frames[0]!, time: at }));
        // The head's position identifies the neighbours that were interpolated.
        const placed = frames.map((frame, i) => ({
          ...frame,
          head: { ...frame.head, position: { x: i, y: 0, z: 0 } },
        }));
        const { x } = sampleRecording({ ...some, frames: placed }, time).head.position;
        const before = Math.max(
          0,
          sorted.findLastIndex((at) => at <= time),
        );
        expect(x).toBeGreaterThanOrEqual(before);
        expect(x).toBeLessThanOrEqual(Math.min(before + 1, sorted.length - 1));
      }),
      { seed },
    );
  });

  test('a hand that a neighbour lacks is not seen: never half-way to nowhere', () => {
    expect(sampleRecording(some, 5.15).leftHand).toBeNull();
    expect(sampleRecording(some, 5.25).leftHand).toBeNull();
    expect(sampleRecording(some, 5.05).leftHand?.position.y).toBeCloseTo(0.5, 9);
  });

  test('before the start and after the end stands the nearest frame', () => {
    expect(sampleRecording(some, 0).head).toEqual(some.frames[0]!.head);
    expect(sampleRecording(some, 99).head).toEqual(some.frames[3]!.head);
    expect(recordingDuration(some)).toBeCloseTo(0.3, 9);
  });
});
