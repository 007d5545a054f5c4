import type { HandShape } from 'threepoint/core';
import { fromAxisAngle, normalise, type Pose, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { fingerNames, relaxedHand } from '../../../src/threepoint/core/body/hand-shape';
import { controller, type Input, trackedHeadset } from './fake-headset';
import { recordedHands, trackedHand } from './recorded-hands';

const wrist: Pose<'floor'> = {
  position: vec3(-0.2, 1.1, -0.4),
  orientation: fromAxisAngle(normalise(vec3(0.3, 1, -0.5)), 2.1),
};

/** A headset that reads the fingers of one frame after the other. */
function tracked() {
  const headset = trackedHeadset();
  return { ...headset, read: (seconds?: number) => headset.read(seconds)!.fingers! };
}

const numbersOf = (shape: HandShape): readonly number[] =>
  fingerNames.flatMap((name) => [shape[name].knuckle, shape[name].spread, shape[name].middle, shape[name].end]);

/** The largest difference of two hands' angles [rad]. */
const apart = (a: HandShape, b: HandShape): number =>
  Math.max(...numbersOf(a).map((angle, i) => Math.abs(angle - numbersOf(b)[i]!)));

describe('fingers of a tracked hand', () => {
  test('are read with the wrist by one call a hand and frame', () => {
    const { poseCalls, setInputs, read } = tracked();
    setInputs(trackedHand('left', wrist, recordedHands.pointing!), trackedHand('right', wrist, recordedHands.pinched!));
    read();
    read();
    expect(poseCalls).toEqual({ fills: 4, joints: 0 });
  });

  test('are the same on a device that reports joints one by one', () => {
    const whole = tracked();
    const single = tracked();
    delete (single.frame as { fillPoses?: unknown }).fillPoses;
    for (const { setInputs } of [whole, single]) setInputs(trackedHand('left', wrist, recordedHands.pointing!));
    expect(apart(whole.read().left!, single.read().left!)).toBeLessThan(1e-5);
    expect(single.poseCalls.joints).toBeGreaterThan(20);
  });

  test('have the same numbers left and right', () => {
    const { setInputs, read } = tracked();
    setInputs(trackedHand('left', wrist, recordedHands.pinched!), trackedHand('right', wrist, recordedHands.pinched!));
    const { left, right } = read();
    expect(apart(left!, right!)).toBeLessThan(1e-5);
    expect(left!.pinch).toBe(1);
  });

  test('point, where the index finger is straight and the others are not', () => {
    const { setInputs, read } = tracked();
    setInputs(trackedHand('right', wrist, recordedHands.pointing!));
    const { index, middle, ring, little } = read().right!;
    expect(index.knuckle + index.middle).toBeLessThan(0.4);
    for (const { knuckle, middle: bent } of [middle, ring, little]) expect(knuckle + bent).toBeGreaterThan(2);
  });

  test('keep their last bend when the device loses them, then relax; the others go on', () => {
    const { setInputs, read } = tracked();
    const hand = trackedHand('right', wrist, recordedHands.pointing!);
    setInputs(hand);
    const before = structuredClone(read().right!);
    const lost: Input = { ...trackedHand('right', wrist, recordedHands['at ease']!) };
    lost.hand!.set('middle-finger-tip', { at: null });
    setInputs(lost);
    const after = structuredClone(read().right!);
    expect(after.middle).toEqual(before.middle);
    expect(after.ring.middle).toBeLessThan(before.ring.middle - 1);
    for (let i = 0; i < 30; i++) read(0.1);
    expect(read().right!.middle.middle).toBeCloseTo(relaxedHand.middle.middle, 2);
  });

  test('are unknown for a hand that is not seen', () => {
    const { setInputs, read } = tracked();
    const hand = trackedHand('right', wrist, recordedHands.pointing!);
    for (const joint of hand.hand.values()) joint.at = null;
    setInputs(hand);
    expect(read()).toEqual({ left: null, right: null });
  });
});

/** A right controller whose buttons are pressed and touched so: [value, touched] in WebXR's order. */
function held(...buttons: readonly (readonly [number, boolean])[]): Input {
  const source = controller('right', wrist);
  source.gamepad.buttons.splice(0, 2, ...buttons.map(([value, touched]) => ({ value, touched })));
  return source;
}

const nothing = [0, false] as const;
const touched = [0, true] as const;
const pushed = [1, true] as const;

describe('fingers on a controller', () => {
  const shown = (...frames: readonly Input[]): HandShape => {
    const { setInputs, read } = tracked();
    let shape: HandShape | null = null;
    for (const input of frames) {
      setInputs(input);
      read(0.5);
      shape = read(0.5).right;
    }
    return structuredClone(shape!);
  };

  test('the trigger bends the index finger alone, the grip the other three', () => {
    const rest = shown(held(touched, nothing, nothing, touched));
    const trigger = shown(held(pushed, nothing, nothing, touched));
    const grip = shown(held(touched, pushed, nothing, touched));
    expect(trigger.index.middle).toBeGreaterThan(rest.index.middle + 0.4);
    expect(trigger.middle).toEqual(rest.middle);
    expect(grip.middle.middle).toBeGreaterThan(rest.middle.middle + 0.4);
    expect(grip.little.middle).toBeGreaterThan(rest.little.middle + 0.4);
    expect(grip.index).toEqual(rest.index);
  });

  test('three fingers lie round the handle while nothing is pressed', () => {
    const { middle, ring, little } = shown(held(touched, nothing, nothing, touched));
    for (const { knuckle, middle: bent } of [middle, ring, little]) expect(knuckle + bent).toBeGreaterThan(1.5);
  });

  test('an index finger off the trigger points, a thumb off the face is up', () => {
    const rest = shown(held(touched, pushed, nothing, touched));
    const pointing = shown(held(nothing, pushed, nothing, touched));
    const thumbUp = shown(held(touched, pushed, nothing, touched), held(pushed, pushed, nothing, nothing));
    expect(pointing.index.middle).toBeLessThan(0.2);
    expect(pointing.thumb).toEqual(rest.thumb);
    expect(thumbUp.thumb.knuckle).toBeLessThan(0.2);
    expect(thumbUp.index.middle).toBeGreaterThan(1);
  });

  test('lie on a controller that feels no touch', () => {
    const { index, thumb } = shown(held(nothing, nothing, nothing, nothing));
    expect(index.middle).toBeGreaterThan(0.5);
    expect(thumb.knuckle).toBeGreaterThan(0.5);
  });

  test('move there, and do not jump', () => {
    const { setInputs, read } = tracked();
    setInputs(held(touched, nothing, nothing, touched));
    const before = read(0.5).right!.index.middle;
    setInputs(held(nothing, nothing, nothing, touched));
    const after = read(1 / 72).right!.index.middle;
    expect(after).toBeLessThan(before);
    expect(after).toBeGreaterThan(before * 0.6);
  });
});
