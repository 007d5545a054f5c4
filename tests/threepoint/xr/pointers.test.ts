import { fromAxisAngle, identity, type Pose, transformPose, type Vec3, vec3 } from 'threepoint/math';
import { ArcheryGestures } from 'threepoint-games/archery';
import { describe, expect, test } from 'vitest';
import { bareHand, controller, type Input, trackedHeadset } from './fake-headset';

const at = (x: number, y: number, z: number, orientation = identity): Pose<'floor'> => ({
  position: vec3(x, y, z),
  orientation,
});
const turned = (axis: Vec3, degrees: number) => fromAxisAngle(axis, (degrees * Math.PI) / 180);
/** A hand ahead of the face whose palm looks back at it, fingers up. */
const palmToFace = at(0.1, 1.55, -0.4, turned(vec3(0, Math.SQRT1_2, -Math.SQRT1_2), 180));
const open = 0.08;
const closed = 0.005;

/** Puts the tip of a fake hand's index finger this far from its thumb [m]. */
function setGap(hand: Input, gap: number): void {
  const tip = hand.hand!.get('index-finger-tip')!;
  const thumb = hand.hand!.get('thumb-tip')!.at!;
  tip.at = transformPose<'floor', 'floor'>({ position: vec3(0, gap, 0), orientation: identity }, thumb);
}

describe('a pointer', () => {
  test('is the ray of a controller, presses once, and is held until the trigger opens', () => {
    const { setInputs, select, read, pointing } = trackedHeadset();
    const right = controller('right', at(0.2, 1.2, -0.3, turned(vec3(0, 1, 0), 90)));
    setInputs(right);
    read();
    const [pointer] = pointing.pointers;
    expect(pointer).toMatchObject({ source: 'controller', side: 'right', pressed: false, held: false, tip: null });
    expect(pointer?.origin).toEqual(vec3(0.2, 1.2, -0.3));
    expect(pointer?.direction.x).toBeCloseTo(-1);
    select('selectstart', right);
    read();
    expect(pointer).toMatchObject({ pressed: true, held: true });
    read();
    expect(pointer).toMatchObject({ pressed: false, held: true });
    select('selectend', right);
    read();
    expect(pointer).toMatchObject({ held: false, cancelled: false });
    expect(pointing.pointers[0]).toBe(pointer);
  });

  test('has a bare hand’s tip of the index finger', () => {
    const { setInputs, read, pointing } = trackedHeadset();
    setInputs(bareHand('left', at(-0.2, 1.2, -0.3), open));
    read();
    expect(pointing.pointers).toMatchObject([{ source: 'hand', side: 'left', tip: vec3(-0.2, 1.2 + open, -0.3) }]);
  });

  test('follows the eyes while its user pinches, beside that hand, and releases when it goes', () => {
    const { setInputs, select, read, pointing } = trackedHeadset();
    const hand = bareHand('right', at(0.2, 1.1, -0.3), closed);
    const pinch: Input = { ...controller('right', at(0, 1.6, 0)), targetRayMode: 'transient-pointer' };
    setInputs(hand, pinch);
    select('selectstart', pinch);
    read();
    expect(pointing.pointers.map(({ source, pressed }) => [source, pressed])).toEqual([
      ['hand', false],
      ['transient', true],
    ]);
    const [, pointer] = pointing.pointers;
    select('selectend', pinch);
    setInputs(hand);
    read();
    expect(pointing.pointers).toHaveLength(1);
    expect(pointer).toMatchObject({ held: false, cancelled: false });
  });

  test('is held for what it pointed at when the hold began, and for nothing else', () => {
    const { setInputs, select, read, pointing } = trackedHeadset();
    const right = controller('right', at(0.2, 1.2, -0.3));
    setInputs(right);
    select('selectstart', right);
    read();
    const pointer = pointing.pointers[0]!;
    pointer.pointAt({ distance: 2, owner: 'game', id: 'target' });
    pointer.pointAt({ distance: 1, owner: 'menu', id: 'exit' });
    read();
    pointer.pointAt({ distance: 2, owner: 'game', id: 'target' });
    expect([pointer.isHeldFor('menu'), pointer.isHeldFor('game')]).toEqual([true, false]);
  });

  test('cancels what it held when the device takes it, and a menu leaves none', () => {
    const { setInputs, select, read, pointing, setVisibility } = trackedHeadset();
    const right = controller('right', at(0.2, 1.2, -0.3));
    setInputs(right);
    select('selectstart', right);
    read();
    const pointer = pointing.pointers[0];
    setVisibility('visible-blurred');
    read();
    expect(pointer).toMatchObject({ held: false, cancelled: true });
    expect(pointing.pointers).toEqual([]);
    setVisibility('visible');
    read();
    expect(pointing.pointers[0], 'a trigger that was never released').toMatchObject({ held: false, pressed: false });
  });
});

describe('a hand that belongs to the device neither points nor presses', () => {
  const gesture = (change: (hand: Input) => void, place = at(0.2, 1.1, -0.3)) => {
    const page = trackedHeadset();
    const hand = bareHand('right', place, open);
    page.setInputs(hand);
    page.read();
    change(hand);
    page.select('selectstart', hand);
    page.read();
    return { ...page, hand };
  };

  test.each([
    ['whose ray the browser takes away', (hand: Input) => Object.assign(hand.targetRaySpace, { at: null })],
    ['whose pinch is the menu button', (hand: Input) => Object.assign(hand.gamepad.buttons, { 4: { pressed: true } })],
  ])('%s', (_, change) => {
    const { inputs, pointing } = gesture((hand) => {
      change(hand);
      setGap(hand, closed);
    });
    expect(inputs.buttons.right).toMatchObject({ taken: true, pinch: 0, kind: 'hand' });
    expect(pointing.pointers).toEqual([]);
  });

  test('from a pinch that begins with the palm towards the face, until it opens', () => {
    const { inputs, pointing, read, hand, select } = gesture((it) => setGap(it, closed), palmToFace);
    expect(inputs.buttons.right).toMatchObject({ taken: true, pinch: 0 });
    expect(pointing.pointers).toEqual([]);
    setGap(hand, open);
    select('selectend', hand);
    read();
    expect(inputs.buttons.right.taken).toBeUndefined();
    expect(pointing.pointers).toMatchObject([{ pressed: false, held: false }]);
  });

  test('a pinch that began elsewhere stays the page’s when the palm turns to the face', () => {
    const { inputs, pointing, read, hand } = gesture((it) => setGap(it, closed));
    expect(inputs.buttons.right.pinch).toBe(1);
    const moved = bareHand('right', palmToFace, closed);
    for (const [name, joint] of moved.hand!) hand.hand!.get(name)!.at = joint.at;
    read();
    expect(inputs.buttons.right).toMatchObject({ pinch: 1 });
    expect(pointing.pointers).toMatchObject([{ held: true }]);
  });

  test('a drawn bow waits for a string hand whose ray is gone: nothing is shot', () => {
    const { setInputs, read, inputs } = trackedHeadset();
    const bow = bareHand('left', at(0, 1.4, -0.6), open);
    const string = bareHand('right', at(0, 1.4, -0.45), open);
    setInputs(bow, string);
    const gestures = new ArcheryGestures(() => ({ bowSide: 'left', oneHanded: false, armed: true }));
    const play = () => gestures.follow(read()!, inputs.buttons);
    for (let frame = 0; frame < 5; frame++) play();
    setGap(string, closed);
    play();
    for (let frame = 0; frame < 60; frame++) {
      for (const joint of string.hand!.values())
        joint.at = { ...joint.at!, position: { ...joint.at!.position, z: joint.at!.position.z + 0.006 } };
      play();
    }
    expect(gestures.follow(read()!, inputs.buttons).bow?.draw).toBeGreaterThan(0.15);
    string.targetRaySpace.at = null;
    setGap(string, open);
    const shots: string[] = [];
    for (let frame = 0; frame < 20; frame++) shots.push(...play().actions.map(({ type }) => type));
    expect(shots).not.toContain('release');
  });
});

describe('without a stick', () => {
  /** A bare hand of this side whose browser reports these buttons of its gamepad as pressed. */
  const reporting = (side: 'left' | 'right', ...pressed: number[]): Input => {
    const hand = bareHand(side, at(0.2, 1.1, -0.3), open);
    const buttons = Array.from({ length: 10 }, (_, index) => ({ value: 0, pressed: pressed.includes(index) }));
    return { ...hand, gamepad: { buttons, axes: [] } };
  };

  test('a thumb that swipes along its finger turns once, to either side', () => {
    const { setInputs, read, pointing } = trackedHeadset();
    const turns = [[6], [6], [], [5], []].map((pressed) => {
      setInputs(reporting('right', ...pressed));
      read();
      return pointing.commands.takeTurn();
    });
    expect(turns).toEqual([-1, 0, 0, 1, 0]);
  });

  test.each([
    ['the menu pinch of a bare left hand', reporting('left', 4)],
    ['a thumb that taps its finger', reporting('right', 9)],
    ['the upper button of a controller', { ...reporting('left', 5), profiles: ['meta-quest-touch-plus'] }],
  ])('%s brings the menu, once', (_, source) => {
    const { setInputs, read, pointing } = trackedHeadset();
    setInputs(source);
    read();
    read();
    expect([pointing.commands.menu.take(), pointing.commands.menu.take()]).toEqual([true, false]);
    expect([pointing.commands.takeTurn(), pointing.commands.mute.take()]).toEqual([0, false]);
  });
});
