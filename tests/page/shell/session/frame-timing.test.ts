import { describe, expect, test } from 'vitest';
import { FrameTiming } from '../../../../src/page/shell/session/frame-timing';

/** A clock that a test turns by hand [ms]. */
function handClock() {
  let time = 0;
  return {
    now: () => time,
    pass(ms: number) {
      time += ms;
    },
  };
}

describe('the time of a frame', () => {
  test('each stage gets the time since the mark before it, the frame gets the sum', () => {
    const clock = handClock();
    const timing = new FrameTiming(clock.now);
    for (let frame = 0; frame < 10; frame++) {
      timing.begin(frame * 16);
      clock.pass(1);
      timing.mark('tracking');
      clock.pass(2);
      timing.mark('features');
      clock.pass(4);
      timing.mark('inference');
      clock.pass(1);
      timing.mark('features');
      timing.end();
    }
    const summary = timing.summary();
    expect(summary.stages.tracking.p50Ms).toBe(1);
    expect(summary.stages.features.p50Ms).toBe(3);
    expect(summary.stages.inference.p50Ms).toBe(4);
    expect(summary.stages.render.p95Ms).toBe(0);
    expect(summary.p50Ms).toBe(8);
  });

  test('work that a frame leaves for later counts with the next one, the pause with none', () => {
    const clock = handClock();
    const timing = new FrameTiming(clock.now);
    for (let frame = 0; frame < 10; frame++) {
      timing.begin(frame * 16);
      clock.pass(2);
      timing.mark('kinematics');
      timing.end();
      clock.pass(7);
      timing.resume();
      clock.pass(1);
      timing.mark('features');
    }
    const summary = timing.summary();
    expect(summary.stages.features.p50Ms).toBe(1);
    expect(summary.p50Ms).toBe(3);
  });

  test('one slow frame in ten shows in p95, not in p50', () => {
    const clock = handClock();
    const timing = new FrameTiming(clock.now);
    for (let frame = 0; frame < 100; frame++) {
      timing.begin(frame);
      clock.pass(frame % 10 === 0 ? 30 : 5);
      timing.end();
    }
    expect(timing.summary()).toMatchObject({ p50Ms: 5, p95Ms: 30 });
  });

  test('a frame is missed when it comes over one and a half device intervals late', () => {
    const timing = new FrameTiming(() => 0);
    timing.setRate(72);
    for (const timestamp of [0, 14, 28, 56, 70, 112]) {
      timing.begin(timestamp);
      timing.end();
    }
    expect(timing.summary()).toMatchObject({ missed: 2, frames: 5, rateHz: 72 });
  });

  test('a pause is no missed frame', () => {
    const timing = new FrameTiming(() => 0);
    timing.begin(0);
    timing.end();
    timing.reset();
    timing.begin(60_000);
    timing.end();
    expect(timing.summary()).toMatchObject({ missed: 0, frames: 0 });
  });
});
