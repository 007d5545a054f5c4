import { expect, test } from 'vitest';
import { reportFigures } from '../reliability/report-figures';
import { bowman } from './archery/bowman';
import { ballThrower } from './ball/ball-thrower';

test('a controller that goes off drops its ball to the rack and returns with nothing', () => {
  const thrower = ballThrower().carry(1);
  thrower.hold({ fist: thrower.side, trigger: 0, device: 2 }, null, 1);
  expect(thrower.held.right).toBeNull();
  thrower.hold({ fist: thrower.side, trigger: 0, device: 2 }, { fist: thrower.chest, trigger: 1, device: 3 }, 0.5);
  expect(thrower.held.right).toBeNull();
  expect(thrower.state.balls[0]).toEqual({ on: 'rack' });
  expect(thrower.actions).toEqual(['grab', 'drop']);
});

test('a held thing stays held when its hand’s device changes after a moment off', () => {
  const thrower = ballThrower().carry(1);
  thrower.hold({ fist: thrower.side, trigger: 0, device: 2 }, null, 0.2);
  thrower.hold({ fist: thrower.side, trigger: 0, device: 2 }, { fist: thrower.chest, trigger: 1, device: 3 }, 0.5);
  expect(thrower.held.right).toBe(0);
});

test('both off: nothing stays in a hand that is gone', () => {
  const thrower = ballThrower().carry(1).hold(null, null, 1);
  expect(thrower.held).toEqual({ left: null, right: null });
  expect(thrower.state.balls[0]).toEqual({ on: 'rack' });
});

test('a held ball is released, never thrown, when the two controllers change sides', () => {
  let thrown = 0;
  let stuck = 0;
  for (const distance of [0.05, 0.2, 0.5, 1]) {
    for (const trigger of [0, 1]) {
      const thrower = ballThrower().carry(1);
      const there = { ...thrower.chest, x: thrower.chest.x + distance };
      // Both sides swap devices in one frame: each has the other's pose and trigger.
      thrower.hold({ fist: thrower.chest, trigger: 1, device: 4 }, { fist: there, trigger, device: 3 }, 0.5);
      thrown += thrower.actions.filter((action) => action === 'throw').length;
      stuck += thrower.held.right === null && thrower.held.left === null ? 0 : 1;
      expect(thrower.state.balls[0]).toEqual({ on: 'rack' });
    }
  }
  expect({ thrown, stuck }).toEqual({ thrown: 0, stuck: 0 });
  reportFigures('controllers', { 'balls stuck': `${stuck} of 8`, 'balls thrown': `${thrown} of 8` });
});

test('a drawn bow whose string hand becomes another device loses its arrow and keeps its side', () => {
  for (const bowSide of ['left', 'right'] as const) {
    const archer = bowman({ bowSide });
    const string = bowSide === 'left' ? 'right' : 'left';
    archer.frame({}, { [string]: { device: 1 } });
    archer.frame({}, { [string]: { device: 1, trigger: 1 } });
    for (let k = 1; k <= 20; k++) archer.frame({ draw: 0.025 * k }, { [string]: { device: 1, trigger: 1 } });
    expect(archer.bow?.stage).not.toBe('empty');
    for (let k = 0; k < 10; k++) archer.frame({ draw: 0.5 }, { [string]: { device: 2, trigger: 0 } });
    expect(archer.bow).toMatchObject({ stage: 'empty', bowSide });
    expect(archer.releases).toEqual([]);
  }
});
