import { allReleased } from 'threepoint/core';
import { ArcheryGestures } from 'threepoint-games/archery';
import { expect, test } from 'vitest';
import { defaultArcheryGestureSettings } from '../../src/games/archery/gestures';
import { reportFigures } from '../reliability/report-figures';
import { bowman, posed } from './archery/bowman';
import { ballThrower } from './ball/ball-thrower';

/** The duration of the system menu [s]: hands and buttons are absent, the head stays tracked. */
const menuSeconds = 10;

/** Runs an archer at full draw through the system menu; afterwards the trigger has this value. */
function archerBehindMenu(pressure: number) {
  const gestures = new ArcheryGestures(() => defaultArcheryGestureSettings);
  const actions: string[] = [];
  const cues: string[] = [];
  let time = 5;
  const frame = (draw: number, trigger: number, suspended = false) => {
    time += 1 / 72;
    const whole = posed(time, { draw });
    const seen = suspended ? ({ ...whole, leftHand: null, rightHand: null, suspended } as const) : whole;
    const done = gestures.follow(seen, { left: allReleased, right: { ...allReleased, trigger } });
    actions.push(...done.actions.map(({ type }) => type));
    cues.push(...done.cues.map(({ type }) => type));
    return done.bow;
  };
  frame(0, 0);
  frame(0, 1);
  for (let i = 1; i <= 60; i++) frame(i / 120, 1);
  let bow = frame(0.5, 1);
  for (let i = 0; i < menuSeconds * 72; i++) bow = frame(0.5, 0, true);
  // The gestures overwrite the view in every frame, so it is copied.
  const meanwhile = structuredClone(bow);
  for (let i = 0; i < 20; i++) bow = frame(0.5, pressure);
  return { bow, meanwhile, cues, shots: actions.filter((type) => type === 'release').length };
}

test('the arrow waits on the string behind a menu; the hand that still holds it continues', () => {
  const { bow, meanwhile, shots } = archerBehindMenu(1);
  expect(meanwhile).toMatchObject({ stage: 'held', draw: 0.5 });
  expect(bow?.stage).not.toBe('empty');
  expect(shots).toBe(0);
});

test('a trigger pressed and let go in the menu shoots nothing: the arrow goes back', () => {
  const { bow, cues, shots } = archerBehindMenu(0);
  expect(shots).toBe(0);
  expect(bow?.stage).toBe('empty');
  expect(cues.at(-1)).toBe('cancelled');
});

test('a bow without an arrow is still in the hand afterwards', () => {
  const archer = bowman();
  archer.hold({}, 0.2);
  expect(archer.bow).not.toBeNull();
});

test('behind a menu a ball stays in its hand; let go there, it is not thrown', () => {
  let thrown = 0;
  for (const rate of [72, 90, 120]) {
    const still = ballThrower(rate).carry();
    still.hold(null, null, menuSeconds, true);
    expect(still.held.right).toBe(0);
    expect(still.state.balls[0]).toMatchObject({ on: 'hand' });
    still.hold({ fist: still.side, trigger: 0 }, { fist: still.chest, trigger: 1 }, 0.2);
    expect(still.held.right).toBe(0);

    const open = ballThrower(rate).carry();
    open.hold(null, null, menuSeconds, true);
    open.hold({ fist: open.side, trigger: 0 }, { fist: open.chest, trigger: 0 }, 0.2);
    expect(open.state.balls[0]).toEqual({ on: 'rack' });
    thrown += [...still.actions, ...open.actions].filter((action) => action === 'throw').length;
    expect(still.actions).toEqual(['grab']);
  }
  expect(thrown).toBe(0);
  reportFigures('blurred', {
    'balls thrown': thrown,
    'arrows shot': archerBehindMenu(0).shots,
    'still held': 'arrow and ball',
  });
});
