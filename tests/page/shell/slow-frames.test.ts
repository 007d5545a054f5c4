import { createPageClock, MutablePointer } from 'threepoint/core';
import { distance, normalise, subtract, vec3 } from 'threepoint/math';
import { landingPointOf } from 'threepoint-games/archery';
import { createBallLoopbackHost } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { probeOf } from '../../../src/page/archery/archery-play';
import { archeryPage, ballPage } from '../playing';

/** Seconds of a time stamp and of the page's clock, which a machine reaches that takes so long for each frame [ms]. */
function slowPage(frameMs: number) {
  let stamp = 10_000;
  const clock = createPageClock(() => stamp);
  return {
    clock,
    get seconds(): number {
      return stamp / 1000;
    },
    next(): number {
      stamp += frameMs;
      return clock.tick(stamp);
    },
  };
}

describe.each([16, 200, 600])('with frames of %d ms', (frameMs) => {
  test('a mouse shoots, the arrow hits what it aims at, and a round lasts its seconds', () => {
    const page = slowPage(frameMs);
    const play = archeryPage({ seconds: 20 });
    const mouse = new MutablePointer('mouse');
    const eyes = vec3(0, 1.6, 0);
    const aimed = play.targets[1]!;
    const step = (held: boolean) => {
      const time = page.next();
      if (page.clock.paused) play.replaceHands();
      mouse.begin();
      mouse.setRay(eyes, normalise(subtract(aimed.centre, eyes)));
      mouse.held = held;
      const { frame, buttons } = play.steer(time, mouse);
      play.follow(frame, buttons);
      return probeOf(play.newest!);
    };
    const run = (seconds: number, held: boolean) => {
      const until = page.seconds + seconds;
      while (page.seconds < until) step(held);
    };
    run(8 * (frameMs / 600), false);
    run(4, true);
    const marked = landingPointOf(play.newest!.bow!, play.targets);
    while (step(false).phase === 'ready') expect(page.seconds).toBeLessThan(60);
    const [began, left] = [page.seconds, probeOf(play.newest!).secondsLeft];
    run(8, false);
    const { secondsLeft, hits } = probeOf(play.newest!);
    expect(left - secondsLeft).toBeCloseTo(page.seconds - began, 1);
    expect(hits).toEqual([1]);
    expect(distance(play.newest!.state.arrows[0]!.landing!.position, marked!)).toBeLessThan(0.05);
    while (step(false).phase === 'running') expect(page.seconds).toBeLessThan(90);
    expect(page.seconds - began).toBeGreaterThan(left - 2 * (frameMs / 1000));
    expect(page.seconds - began).toBeLessThan(left + 2 * (frameMs / 1000));
  });

  test('a match of the ball game lasts its seconds, and balls that built-in players throw score', () => {
    const page = slowPage(frameMs);
    const host = createBallLoopbackHost({ seed: 5, ball: { seconds: 60 } });
    const play = ballPage(host, { bots: () => true, readyByItself: () => true, seed: 3 });
    const step = () => {
      const time = page.next();
      play.begin(time);
      const performed = play.act(time);
      if (performed) play.follow(time, performed.frame, performed.buttons);
      return play.probe();
    };
    while (step()?.phase !== 'running') expect(page.seconds).toBeLessThan(60);
    const [began, before] = [page.seconds, play.probe()!.secondsLeft];
    while (page.seconds < began + 15) step();
    expect(before - play.probe()!.secondsLeft).toBeCloseTo(page.seconds - began, 1);
    expect(play.probe()!.score).toBeGreaterThan(0);
  });
});
