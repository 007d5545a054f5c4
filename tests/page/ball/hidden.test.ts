import { allReleased, createEstimator, defaultCalibration, unknownFingers } from 'threepoint/core';
import { createBallLoopbackHost } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { reportFigures } from '../../reliability/report-figures';
import { poseOf } from '../../threepoint/core/estimation/drawn';
import { ballPage } from '../playing';

const released = { left: allReleased, right: allReleased };

/** Returns a player in a local room. A player whose headset is off draws no frames. */
function person(host: ReturnType<typeof createBallLoopbackHost>, name: string, seat: number) {
  const play = ballPage(host, { name, seat, readyByItself: () => true, seed: 3 });
  const estimator = createEstimator('ik', defaultCalibration);
  return {
    play,
    frame(time: number) {
      play.begin(time);
      const performed = play.act(time);
      const seen = play.follow(time, performed?.frame ?? null, performed?.buttons ?? released);
      if (performed) play.sendPose(performed.frame.time, poseOf(estimator, performed.frame), unknownFingers);
      return seen;
    },
  };
}

test('a headset taken off for 20 s is “away” to others within 3 s; play resumes', {
  tags: ['full'],
}, () => {
  const rows: Record<string, string> = {};
  for (const told of [true, false]) {
    const host = createBallLoopbackHost({ seed: 5 });
    const ann = person(host, 'Ann', 0);
    const cal = person(host, 'Cal', 2);
    let time = 50;
    const pass = (seconds: number, both: boolean, until: () => boolean = () => false): number => {
      const start = time;
      while (time - start < seconds && !until()) {
        time += 1 / 72;
        if (both) ann.frame(time);
        cal.frame(time);
      }
      return time - start;
    };
    const presence = () => cal.play.probe()?.people[0]?.presence;
    pass(8, true, () => cal.play.probe()?.phase === 'running');
    expect(cal.play.probe()?.phase).toBe('running');
    if (told) ann.play.away(true);
    const away = pass(5, false, () => presence() === 'away');
    expect(away).toBeLessThan(3);
    pass(20 - away, false);
    const { score = 0 } = cal.play.probe() ?? {};
    if (told) ann.play.away(false);
    const back = pass(5, true, () => presence() === 'here' && ann.play.newest !== null);
    expect(back).toBeLessThan(1);
    expect(ann.play.probe()).toMatchObject({ seat: 0, role: 'thrower', connection: 'joined' });
    expect(ann.play.probe()?.score).toBeGreaterThanOrEqual(score);
    const before = cal.play.probe()?.balls.rack ?? 0;
    pass(10, true, () => (cal.play.probe()?.balls.rack ?? 0) < before);
    expect(cal.play.probe()?.balls.rack, 'Ann throws again').toBeLessThan(before);
    rows[told ? '“away” when the page says so' : '“away” when it does not say so'] =
      `after ${away.toFixed(2)} s, back after ${back.toFixed(2)} s`;
  }
  reportFigures('hidden', rows);
});
