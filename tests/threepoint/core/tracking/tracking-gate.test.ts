import { expect, test } from 'vitest';
import { identity } from '../../../../src/threepoint/core/math/quat';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { TrackingGate, validFrames } from '../../../../src/threepoint/core/tracking/tracking-gate';

const point = (x: number, tracking: 'tracked' | 'emulated' = 'tracked') => ({
  ...{ position: { x, y: 1.2, z: -0.3 }, orientation: identity, tracking },
});
const frame: TrackingFrame = { time: 1, head: point(0), leftHand: point(-0.3), rightHand: point(0.3) };
const guessed: TrackingFrame = { ...frame, leftHand: point(-0.3, 'emulated') };

function gateOf(assumesTracked: boolean) {
  const events: string[] = [];
  const onChange = (name: string, tracked: boolean) => void events.push(`${name} ${tracked ? 'found' : 'lost'}`);
  return { gate: new TrackingGate({ assumesTracked, onChange }), events };
}

test('a hand that a device only guesses counts as tracked until the device has reported it as tracked', () => {
  const { gate } = gateOf(true);
  expect(gate.validate(guessed)).toMatchObject({ leftHand: { tracking: 'tracked' } });
  expect(gate.validate(frame)).toBe(frame);
  expect(gate.validate(guessed)).toBe(guessed);
});

test('a guessed hand of a page’s own frames is lost', () => {
  const { gate, events } = gateOf(false);
  expect(gate.validate(guessed)).toBe(guessed);
  expect(events).toEqual(['head found', 'right found']);
});

test('each change is reported once, and a frame without a head loses every point', () => {
  const { gate, events } = gateOf(false);
  for (const next of [frame, frame, guessed, null, null, frame]) gate.validate(next);
  expect(events).toEqual([
    ...['head found', 'left found', 'right found', 'left lost'],
    ...['head lost', 'right lost', 'head found', 'left found', 'right found'],
  ]);
});

test('after a reset every point is found again without having been reported as lost', () => {
  const { gate, events } = gateOf(false);
  gate.validate(frame);
  events.length = 0;
  gate.reset();
  expect(events).toEqual([]);
  gate.validate(frame);
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
