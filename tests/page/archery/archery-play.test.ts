import { allReleased, createPageClock, defaultCalibration } from 'threepoint/core';
import { vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { probeOf } from '../../../src/page/archery/archery-play';
import { type Posed, posed } from '../../games/archery/bowman';
import { archeryPage } from '../playing';

const frameMs = 1000 / 72;

/**
 * A page at 72 Hz on which a person shoots with the left hand on the bow; time stamps in milliseconds, as the device
 * gives them.
 */
function range(settings: { readonly seconds?: number } = {}) {
  const play = archeryPage(settings);
  let stamp = 30_000;
  const clock = createPageClock(() => stamp);
  const said: string[] = [];
  const frame = (pose: Posed, trigger: number, ms = frameMs) => {
    stamp += ms;
    const buttons = { left: allReleased, right: { ...allReleased, trigger } };
    const time = clock.tick(stamp);
    if (clock.paused) play.replaceHands();
    const { cues, events } = play.follow(posed(time, pose), buttons);
    said.push(...[...cues, ...events].map(({ type }) => type).filter((type) => type !== 'creak'));
  };
  return {
    play,
    said,
    frame,
    hold(pose: Posed, trigger: number, seconds: number) {
      for (let i = 0; i < Math.round(seconds * 72); i++) frame(pose, trigger);
    },
  };
}

test.each([0.6, 3, 600])('a headset taken off at full draw for %d s, frames and all, shoots no arrow', (away) => {
  const { play, said, frame, hold } = range();
  hold({}, 0, 0.1);
  hold({}, 1, 0.1);
  for (let i = 1; i <= 36; i++) frame({ draw: i / 72 }, 1);
  hold({ draw: 0.5 }, 1, 0.5);
  expect(play.newest?.bow?.stage).toBe('anchored');
  frame({ draw: 0.5 }, 0, 1000 * away);
  hold({ draw: 0.5 }, 0, 0.2);
  expect(said.at(-1)).toBe('cancelled');
  expect(play.newest?.state).toMatchObject({ phase: 'ready', arrowsLeft: 5 });
});

test('a new round begins with five arrows and an undrawn bow', () => {
  const { play, said, frame, hold } = range();
  hold({}, 0, 0.1);
  hold({}, 1, 0.1);
  hold({ draw: 0.5 }, 1, 0.5);
  expect(play.newest?.bow?.stage).toBe('anchored');
  play.restart(defaultCalibration);
  frame({}, 0);
  hold({}, 0, 0.2);
  expect(said).not.toContain('released');
  expect(play.newest?.state).toMatchObject({ phase: 'ready', arrowsLeft: 5 });
});

test('no arrow is nocked after the bell, even while the last one flies', () => {
  const { play, said, frame, hold } = range({ seconds: 2 });
  const upward: Posed = { direction: vec3(0, 2, -1) };
  const drawn = { ...upward, draw: 0.5 };
  hold(upward, 0, 0.1);
  hold(upward, 1, 0.1);
  hold(drawn, 1, 0.5);
  hold(upward, 0, 0.5);
  hold(upward, 1, 0.1);
  hold(drawn, 1, 2);
  expect(play.newest?.state).toMatchObject({ phase: 'running', arrowsLeft: 4 });
  expect(said.at(-1)).toBe('cancelled');
  frame(drawn, 0);
  hold(upward, 0, 0.1);
  hold(upward, 1, 0.1);
  expect(said.filter((type) => type === 'nocked')).toHaveLength(2);
});

test('the time of a round that a last arrow needs to land goes on after it', () => {
  const { play, hold } = range({ seconds: 1 });
  hold({}, 0, 0.1);
  hold({}, 1, 0.1);
  hold({ draw: 0.5 }, 1, 0.5);
  hold({}, 0, 0.9);
  const before = play.newest;
  expect(before?.state.phase).toBe('running');
  hold({}, 0, 3);
  expect(play.newest?.state.phase).toBe('over');
  expect(play.newest?.time).toBeCloseTo(before!.time + 3, 6);
  expect(probeOf(play.newest!).secondsLeft).toBe(0);
});
