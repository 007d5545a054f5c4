import { createEstimator, defaultCalibration } from 'threepoint/core';
import { expect, test } from 'vitest';
import { collectGarbage } from '../../collect-garbage.mjs';
import { isNightly } from '../../nightly';
import { reportFigures } from '../../reliability/report-figures';
import { poseOf } from '../../threepoint/core/estimation/drawn';
import { archeryPage } from '../playing';

const heap = (): number => {
  collectGarbage();
  collectGarbage();
  return process.memoryUsage().heapUsed / 2 ** 20;
};

test('a program that plays and estimates keeps nothing of the rounds that are over', { tags: ['full'] }, () => {
  const minutes = isNightly ? 20 : 4;
  let seed = 1;
  const play = archeryPage({}, () => seed);
  const estimator = createEstimator('ik', defaultCalibration);
  let time = 10;
  const heaps: number[] = [];
  while (time < 10 + minutes * 60) {
    time += 1 / 72;
    const { frame, buttons } = play.act(time);
    const { state } = play.follow(frame, buttons);
    poseOf(estimator, frame);
    if (state.phase !== 'over') continue;
    expect(state.score).toBe(50);
    seed += 1;
    play.restart(defaultCalibration);
    heaps.push(heap());
  }
  const [first = Number.NaN] = heaps;
  const last = heaps.at(-1) ?? Number.NaN;
  expect(heaps.length).toBeGreaterThan(3);
  expect(last).toBeLessThan(1.1 * first);
  reportFigures('long-run', {
    'without a page': `${minutes} min, ${heaps.length} rounds: heap ${first.toFixed(1)} MB after the first, ${last.toFixed(1)} MB after the last`,
  });
});
