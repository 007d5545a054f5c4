import { expect, test } from 'vitest';
import { identity } from '../../../../src/threepoint/core/math/quat';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { TrackedPoints, TrackingGate, validFrames } from '../../../../src/threepoint/core/tracking/tracking-gate';

const point = (x: number, tracking: 'tracked' | 'emulated' = 'tracked') => ({
  ...{ position: { x, y: 1.2, z: -0.3 }, orientation: identity, tracking },
});
const frame: TrackingFrame = { time: 1, head: point(0), leftHand: point(-0.3), rightHand: point(0.3) };
const guessed: TrackingFrame = { ...frame, leftHand: point(-0.3, 'emulated') };

function gateOf(assumesTracked: boolean) {
  const events: string[] = [];
  const gate = new TrackingGate({ assumesTracked });
  const points = new TrackedPoints((name, tracked) => void events.push(`${name} ${tracked ? 'found' : 'lost'}`));
  const validate = (next: TrackingFrame | null) => {
    const valid = gate.validate(next);
    points.follow(valid);
    return valid;
  };
  return { validate, reset: () => points.reset(), events };
}

test('a hand that a device only guesses counts as tracked until the device reports it tracked', () => {
  const { validate } = gateOf(true);
  expect(validate(guessed)).toMatchObject({ leftHand: { tracking: 'tracked' } });
  expect(validate(frame)).toBe(frame);
  expect(validate(guessed)).toBe(guessed);
});

test('a guessed hand of a page’s own frames is lost', () => {
  const { validate, events } = gateOf(false);
  expect(validate(guessed)).toBe(guessed);
  expect(events).toEqual(['head found', 'right found']);
});

test('each change is reported once, and a frame without a head loses every point', () => {
  const { validate, events } = gateOf(false);
  for (const next of [frame, frame, guessed, null, null, frame]) validate(next);
  expect(events).toEqual([
    ...['head found', 'left found', 'right found', 'left lost'],
    ...['head lost', 'right lost', 'head found', 'left found', 'right found'],
  ]);
});

test('after a reset every point is found again without having been reported as lost', () => {
  const { validate, reset, events } = gateOf(false);
  validate(frame);
  events.length = 0;
  reset();
  expect(events).toEqual([]);
  validate(frame);
  expect(events).toEqual(['head found', 'left found', 'right found']);
});

test('a corrected copy keeps what is not corrected', () => {
  const suspended: TrackingFrame = { ...frame, suspended: true, leftHand: null };
  expect(
    new TrackingGate().validate({ ...suspended, rightHand: { ...point(0.3), position: { x: NaN, y: 0, z: 0 } } }),
  ).toEqual({
    ...suspended,
    rightHand: null,
  });
});

test('frames of a recording without a head are left out', () => {
  // reason: a page without types
  const headless = { ...frame, head: null } as unknown as TrackingFrame;
  expect([...validFrames([headless, frame, headless])]).toEqual([frame]);
});
