import { angleBetween, distance, fromAxisAngle, identity, type Pose, up, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { TrackedSession } from '../../../src/threepoint/xr/tracked-session';
import { reportFigures } from '../../reliability/report-figures';
import { bareHand, controller, fakeHeadset, trackedHeadset } from './fake-headset';

const at = (x: number, y: number, z: number): Pose<'floor'> => ({ position: vec3(x, y, z), orientation: identity });
const left = at(-0.25, 1.1, -0.35);
const right = at(0.25, 1.1, -0.35);

describe('poses', () => {
  test('need a head: unseen or invalid, it leaves no frame, and the next is whole', () => {
    const { read, setHead, setInputs } = trackedHeadset();
    setInputs(controller('left', left), controller('right', right));
    const before = read();
    setHead(null);
    expect(read()).toBeNull();
    setHead(at(Number.NaN, 1.6, 0));
    expect(read()).toBeNull();
    setHead(at(0, 1.6, 0));
    expect({ ...read(), time: 0 }).toEqual({ ...before, time: 0 });
  });

  test('show hands as reported: null is unseen, emulated is marked, an invalid number is unseen', () => {
    const { read, setInputs } = trackedHeadset();
    setInputs(controller('left', left), controller('right', right));
    read();
    setInputs(controller('left', null), controller('right', { ...right, emulated: true }));
    expect(read()).toMatchObject({ leftHand: null, rightHand: { tracking: 'emulated' } });
    setInputs(controller('left', at(0, Number.POSITIVE_INFINITY, 0)), bareHand('right', right));
    expect(read()).toMatchObject({ leftHand: null, rightHand: { tracking: 'tracked' } });
  });

  test('count as tracked, each point separately, until the device first reports one as tracked', () => {
    const { read, setInputs } = trackedHeadset();
    const guessed = { left: { ...left, emulated: true }, right: { ...right, emulated: true } };
    setInputs(controller('left', guessed.left), controller('right', guessed.right));
    expect(read()).toMatchObject({ leftHand: { tracking: 'tracked' }, rightHand: { tracking: 'tracked' } });
    setInputs(controller('left', left), controller('right', guessed.right));
    read();
    setInputs(controller('left', guessed.left), controller('right', guessed.right));
    expect(read()).toMatchObject({ leftHand: { tracking: 'emulated' }, rightHand: { tracking: 'tracked' } });
  });

  test('are copies: what the device does with its own objects later changes nothing', () => {
    const { read, setInputs } = trackedHeadset();
    const source = controller('right', right);
    setInputs(source);
    const frame = read();
    source.gripSpace.at = left;
    expect(frame?.rightHand?.position.x).toBeGreaterThan(0);
  });
});

describe('behind a menu of the device', () => {
  test.each(['visible-blurred', 'hidden'] as const)('(%s) the head goes on, no hand and no button is read', (state) => {
    const { read, setInputs, setVisibility, inputs } = trackedHeadset();
    setInputs(controller('left', left, 1), controller('right', right, 1));
    expect(read()?.suspended).toBeUndefined();
    setVisibility(state);
    expect(read()).toMatchObject({ suspended: true, leftHand: null, rightHand: null });
    expect(inputs.buttons.right.trigger).toBe(0);
    setVisibility('visible');
    expect(read()).toMatchObject({ leftHand: { tracking: 'tracked' } });
    expect(inputs.buttons.right.trigger).toBe(1);
  });
});

describe('the hand on a side', () => {
  test('is decided by handedness, in any order, and a swap is another device on each side', () => {
    const { read, setInputs, inputs } = trackedHeadset();
    setInputs(controller('right', right), controller('left', left));
    expect(read()).toMatchObject({ leftHand: {}, rightHand: {} });
    expect(read()?.leftHand?.position.x).toBeLessThan(0);
    const before = { left: inputs.buttons.left.device, right: inputs.buttons.right.device };
    // WebXR makes new input sources where handedness changes.
    setInputs(controller('left', right), controller('right', left));
    expect(read()?.leftHand?.position.x).toBeGreaterThan(0);
    expect(inputs.buttons.left.device).not.toBe(before.left);
    expect(inputs.buttons.right.device).not.toBe(before.right);
  });

  test('is the visible one of two devices there, in whichever order they are listed', () => {
    const { read, setInputs, inputs } = trackedHeadset();
    const onTheTable = controller('left', null, 1);
    const hand = bareHand('left', left, 0.005);
    for (const listed of [
      [onTheTable, hand],
      [hand, onTheTable],
    ]) {
      setInputs(...listed);
      expect(read()?.leftHand?.position.x).toBeCloseTo(left.position.x, 6);
      expect(inputs.kinds.left).toBe('hand');
      expect(inputs.buttons.left).toMatchObject({ kind: 'hand', device: 2 });
    }
    expect(inputs.input).toBe('hands');
  });

  test('is the hand itself while its pinch is reported as a separate pointer', () => {
    const { read, setInputs, inputs } = trackedHeadset();
    const hand = bareHand('right', right, 0.005);
    setInputs(hand);
    const before = read()?.rightHand;
    const pinch = { ...controller('right', at(0.3, 1.2, -0.45), 1), targetRayMode: 'transient-pointer' as const };
    setInputs(hand, pinch);
    expect(read()?.rightHand).toEqual(before);
    expect(inputs.kinds.right).toBe('hand');
    expect(inputs.buttons.right).toMatchObject({ kind: 'hand', trigger: 0 });
    expect(inputs.input).toBe('hands');
  });

  test.each(['listed first', 'listed last'])(
    'is the hand, not the controller on the table that is tracked, %s',
    (order) => {
      const { read, setInputs, inputs } = trackedHeadset();
      const onTheTable = controller('left', at(-0.6, 0.7, -0.5));
      const hand = bareHand('left', left);
      setInputs(...(order === 'listed first' ? [hand, onTheTable] : [onTheTable, hand]));
      expect(read()?.leftHand?.position.x).toBeCloseTo(left.position.x, 6);
      expect(inputs.kinds.left).toBe('hand');
    },
  );

  test.each(['listed first', 'listed last'])('is the one that moves of two controllers, %s', (order) => {
    const { read, setInputs, inputs } = trackedHeadset();
    const held = controller('left', left);
    const onTheTable = controller('left', at(-2, 0.7, -0.5));
    setInputs(...(order === 'listed first' ? [held, onTheTable] : [onTheTable, held]));
    for (let step = 0; step < 20; step++) {
      held.gripSpace.at = at(-0.25 + 0.005 * step, 1.1, -0.35);
      // Noise at rest moves no arm.
      onTheTable.gripSpace.at = at(-2 + 0.004 * Math.sin(step), 0.7, -0.5);
      read();
    }
    const device = inputs.buttons.left.device;
    held.gripSpace.at = left;
    for (let step = 0; step < 100; step++) expect(read()?.leftHand?.position.x).toBeGreaterThan(-1);
    expect(inputs.buttons.left.device).toBe(device);
    // The other is taken up, and its movement has to outlast a short rest of the first.
    for (let step = 0; step < 50; step++) {
      onTheTable.gripSpace.at = at(-2, 0.7 + 0.01 * step, -0.5);
      read();
    }
    expect(read()?.leftHand?.position.x).toBeLessThan(-1);
    expect(inputs.buttons.left.device).not.toBe(device);
  });

  test('is a bare hand where the device reports no joints, and pinches when the device selects', () => {
    const { read, setInputs, inputs, session } = trackedHeadset();
    const hand = { ...controller('right', right), profiles: ['generic-hand-select'] };
    const source = { ...hand, gamepad: { buttons: [], axes: [] } };
    setInputs(source);
    const wrist = read()?.rightHand;
    // A rod across the palm: the hand is level where the rod is, and does not lean by the angle of a controller.
    expect(wrist && distance(wrist.position, right.position)).toBeLessThan(0.07);
    expect(inputs.kinds.right).toBe('hand');
    expect(inputs.input).toBe('hands');
    const select = (type: string) =>
      session.dispatchEvent(Object.assign(new Event(type), { inputSource: source, frame: {} }));
    select('selectstart');
    read();
    expect(inputs.buttons.right).toMatchObject({ kind: 'hand', pinch: 1, trigger: 0 });
    expect(inputs.fingers.right?.pinch).toBe(1);
    select('selectend');
    read();
    expect(inputs.buttons.right.pinch).toBe(0);
  });

  test('is a bare hand where the device has hands but not the wrist of this one', () => {
    const { read, setInputs, inputs } = trackedHeadset();
    setInputs({ ...controller('right', right, 0.8), profiles: [], hand: new Map() });
    const wrist = read()?.rightHand;
    expect(wrist && distance(wrist.position, right.position)).toBeLessThan(0.07);
    expect(inputs.buttons.right).toMatchObject({ kind: 'hand', pinch: 0.8, trigger: 0 });
  });

  test('is where it pinches if a device reports nothing else', () => {
    const { read, setInputs, inputs } = trackedHeadset();
    setInputs({ ...controller('right', right, 1), targetRayMode: 'transient-pointer' });
    expect(read()?.rightHand).not.toBeNull();
    expect(inputs.buttons.right.trigger).toBe(1);
  });

  test('has the right kind through ten changes of controllers and hands, keeping nothing of the other', () => {
    const { read, setInputs, inputs } = trackedHeadset();
    let correct = 0;
    for (let i = 0; i < 10; i++) {
      setInputs(controller('left', left, 1), controller('right', right, 1));
      read();
      if (inputs.kinds.left === 'controller' && inputs.buttons.left.pinch === 0) correct += 1;
      setInputs(bareHand('left', left, 0.005), bareHand('right', right, 0.005));
      read();
      const { trigger, grip, pinch } = inputs.buttons.left;
      if (inputs.kinds.left === 'hand' && trigger === 0 && grip === 0 && pinch === 1) correct += 1;
    }
    setInputs();
    expect(read()).toMatchObject({ leftHand: null, rightHand: null });
    expect(inputs.kinds).toEqual({ left: 'none', right: 'none' });
    expect(correct).toBe(20);
    reportFigures('changing-hands', { 'right kind': `${correct} of 20` });
  });
});

describe('events', () => {
  /** A session whose events are recorded in their order. */
  function observed() {
    const headset = fakeHeadset();
    const events: string[] = [];
    const session = new TrackedSession({
      ...headset,
      onStart: () => void events.push('start'),
      onDiscontinuity: () => void events.push('discontinuity'),
      onEnd: () => void events.push('end'),
    });
    return { ...headset, tracked: session, events };
  }

  test('report the start with the first frame, and each move of the floor', () => {
    const { tracked, frame, events, reset } = observed();
    expect(events).toEqual([]);
    tracked.read(frame, 1);
    tracked.read(frame, 1.01);
    tracked.recentre();
    tracked.turn(0.5);
    reset({ position: vec3(1, 0, 0), orientation: identity });
    expect(events).toEqual(['start', 'discontinuity', 'discontinuity', 'discontinuity']);
  });

  test('report the end once; a floor moved later is no more the session’s', () => {
    const { tracked, session, frame, events, reset } = observed();
    tracked.read(frame, 1);
    session.dispatchEvent(new Event('end'));
    session.dispatchEvent(new Event('end'));
    reset({ position: vec3(1, 0, 0), orientation: identity });
    expect(events).toEqual(['start', 'end']);
  });

  test('start once the renderer has a space', () => {
    const { tracked, drawing, floor, frame, events } = observed();
    drawing.getReferenceSpace = () => null;
    expect(tracked.read(frame, 1)).toBeNull();
    drawing.getReferenceSpace = () => floor;
    expect(tracked.read(frame, 1.01)).not.toBeNull();
    expect(events).toEqual(['start']);
  });
});

describe('the floor', () => {
  test('after recentring lies under the head, and the hands keep their distances', () => {
    const { read, setHead, setInputs, tracker, spaces } = trackedHeadset();
    setHead({ position: vec3(1, 1.6, 2), orientation: fromAxisAngle(up, 2) });
    setInputs(controller('right', right));
    const before = read();
    tracker.recentre();
    const after = read();
    expect(distance(after!.head.position, vec3(0, 1.6, 0))).toBeLessThan(1e-9);
    expect(angleBetween(after!.head.orientation, identity)).toBeLessThan(1e-9);
    expect(distance(after!.head.position, after!.rightHand!.position)).toBeCloseTo(
      distance(before!.head.position, before!.rightHand!.position),
      9,
    );
    expect(spaces).toHaveLength(1);
  });

  test.each([
    ['again', (tracker: TrackedSession) => tracker.recentre(), 0],
    ['and turned', (tracker: TrackedSession) => tracker.turn(1), 1],
  ])('after recentring %s before the next frame lies under the head too', (_, then, yaw) => {
    const { read, setHead, tracker } = trackedHeadset();
    setHead({ position: vec3(1, 1.6, 2), orientation: fromAxisAngle(up, 2) });
    read();
    tracker.recentre();
    then(tracker);
    const { head } = read()!;
    expect(distance(head.position, vec3(0, 1.6, 0))).toBeLessThan(1e-9);
    expect(angleBetween(head.orientation, fromAxisAngle(up, yaw))).toBeLessThan(1e-6);
  });

  test('is as far below the user as requested, with head and hands, through recentring and turns', () => {
    const { read, setHead, setInputs, tracker, reset } = trackedHeadset();
    setHead(at(0.2, 1.15, 0));
    setInputs(controller('right', at(0.3, 0.8, -0.3)));
    const before = read()!;
    tracker.setHeightOffset(0.45);
    const seen = () => {
      const { head, rightHand } = read()!;
      return [head.position.y, rightHand!.position.y - head.position.y];
    };
    const arm = before.rightHand!.position.y - before.head.position.y;
    const expectRaised = ([height, hand]: number[], by: number) => {
      expect(height).toBeCloseTo(1.15 + by, 9);
      expect(hand).toBeCloseTo(arm, 9);
    };
    expectRaised(seen(), 0.45);
    tracker.recentre();
    tracker.turn(0.5);
    expectRaised(seen(), 0.45);
    expect(read()?.head.position.x).toBeCloseTo(0, 9);
    reset({ position: vec3(0, 0, 1), orientation: identity });
    expectRaised(seen(), 0.45);
    tracker.setHeightOffset(0.5);
    tracker.setHeightOffset(Number.NaN);
    expect(tracker.heightOffset).toBe(0.5);
    tracker.setHeightOffset(0);
    expectRaised(seen(), 0);
  });

  test('turns about the head, which stays: thirty degrees a push, one turn for one push', () => {
    const { read, setHead, setInputs, tracker, inputs } = trackedHeadset();
    setHead({ position: vec3(1, 1.6, 2), orientation: fromAxisAngle(up, 0.4) });
    const source = controller('right', right);
    setInputs(source);
    const before = read()!;
    source.gamepad.axes[2] = 0.9;
    read();
    expect(inputs.pointing?.commands.takeTurn()).toBe(-1);
    read();
    expect(inputs.pointing?.commands.takeTurn(), 'the stick is still there').toBe(0);
    tracker.turn(-Math.PI / 6);
    const after = read()!;
    const off = 1000 * distance(after.head.position, before.head.position);
    expect(off).toBeLessThan(1e-6);
    expect(angleBetween(after.head.orientation, fromAxisAngle(up, 0.4 - Math.PI / 6))).toBeLessThan(1e-6);
    source.gamepad.axes[2] = 0;
    read();
    source.gamepad.axes[2] = -0.9;
    read();
    expect(inputs.pointing?.commands.takeTurn()).toBe(1);
    reportFigures('comfort', { 'a turn moves the head by': `${off.toFixed(3)} mm` });
  });

  test('is where the device puts it when recentring: earlier turns are forgotten', () => {
    const { read, setHead, setInputs, tracker, reset, spaces, floor } = trackedHeadset();
    setInputs(controller('right', right));
    read();
    tracker.turn(1);
    setHead({ position: vec3(1, 1.6, 0), orientation: fromAxisAngle(up, Math.PI / 2) });
    // The device puts the origin a metre to the side and turns it by a quarter: under the head, as it looks.
    reset({ position: vec3(1, 0, 0), orientation: fromAxisAngle(up, Math.PI / 2) });
    expect(spaces.at(-1)).toBe(floor);
    const { head } = read()!;
    expect(distance(head.position, vec3(0, 1.6, 0))).toBeLessThan(1e-9);
    expect(angleBetween(head.orientation, identity)).toBeLessThan(1e-9);
  });

  test('is independent of a finished tracker: a device that recentres later moves nothing', () => {
    const { read, tracker, reset, spaces } = trackedHeadset();
    read();
    tracker.turn(1);
    tracker.dispose();
    reset({ position: vec3(1, 0, 0), orientation: identity });
    expect(spaces).toHaveLength(1);
  });
});
