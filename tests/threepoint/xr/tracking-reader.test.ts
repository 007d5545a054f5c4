import { identity, type Pose, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { TrackingReader } from '../../../src/threepoint/xr/tracking-reader';
import { bareHand, controller, fakeHeadset } from './fake-headset';

const at = (x: number, y: number, z: number): Pose<'floor'> => ({ position: vec3(x, y, z), orientation: identity });
const left = at(-0.25, 1.1, -0.35);
const right = at(0.25, 1.1, -0.35);

test('a frame and a space give wrists, fingers and lost hands, without an engine', () => {
  const headset = fakeHeadset();
  const reader = new TrackingReader(headset.session);
  const read = (timeMs: number) => reader.read(timeMs, headset.frame, headset.floor);
  headset.setHead(at(0, 1.6, 0));
  headset.setInputs(controller('left', left), bareHand('right', right));
  const frame = read(2500)!;
  expect(frame.time).toBe(2.5);
  // The wrist is 8 cm behind the middle of the fist, not in it.
  expect(Math.hypot(frame.leftHand!.position.z + 0.35, frame.leftHand!.position.y - 1.1)).toBeGreaterThan(0.05);
  expect(frame.fingers!.right).not.toBeNull();
  headset.setInputs(controller('left', null), bareHand('right', right));
  expect(read(2516)).toMatchObject({ leftHand: null, rightHand: { tracking: 'tracked' } });
  headset.setHead(null);
  expect(read(2533)).toBeNull();
});

test('the hand is read where a controller of the same side lies on the table', () => {
  const headset = fakeHeadset();
  const reader = new TrackingReader(headset.session);
  headset.setHead(at(0, 1.6, 0));
  headset.setInputs(controller('right', at(0.5, 0.7, -0.5)), bareHand('right', right));
  const { rightHand } = reader.read(0, headset.frame, headset.floor)!;
  expect(rightHand!.position.y).toBeGreaterThan(1);
  expect(reader.inputs.kinds.right).toBe('hand');
});
