// One method of docs/board.md (?method=…), frame by frame and without a picture: the time until a frame has its body.
import {
  actorFrame,
  createEstimator,
  defaultCalibration,
  skeletonFromCalibration,
  type TrackingFrame,
} from 'threepoint/core';
import { createWithNetwork } from '../../src/threepoint/core/estimation/with-network';
import { quantile } from '../../src/threepoint/core/math/statistics';
import { loadPlainRegressor } from '../../src/threepoint/onnx/load-plain-regressor';
import { loadRegressor } from '../../src/threepoint/onnx/load-regressor';
import { fetchContract } from '../../src/threepoint/onnx/model-files';
import { type BoardTime, startFieldNetwork, type TimedMethod } from '../board-methods';
import { createWithWindows } from '../evaluate/window-source';
import { createCcdBody } from './ccd-body';
import { reportOutcome } from './outcome';

const measured = 300;
const warmUp = 100;
const rateHz = 60;

/** Returns what a method does in a frame. */
async function frameOf(method: TimedMethod): Promise<(frame: TrackingFrame) => unknown> {
  if (method === 'ccd') {
    const body = createCcdBody(skeletonFromCalibration(defaultCalibration));
    return (frame) => body.solve(frame);
  }
  const estimator = await estimatorOf(method);
  return (frame) => estimator.update(frame).request?.ask();
}

async function estimatorOf(method: Exclude<TimedMethod, 'ccd'>) {
  if (method === 'hands-only' || method === 'ik') return createEstimator(method, defaultCalibration);
  const learned = '/models/learned.json';
  if (method === 'learned') return createWithNetwork(method, defaultCalibration, await loadPlainRegressor(learned));
  if (method === 'paper') {
    return createWithNetwork(method, defaultCalibration, await loadRegressor('/models/paper.json'));
  }
  const model = new Uint8Array(await (await fetch(`/board/${method}.onnx`)).arrayBuffer());
  const regressor = await startFieldNetwork(await fetchContract(learned), model);
  return createWithWindows(defaultCalibration, regressor);
}

async function measure(method: TimedMethod): Promise<BoardTime> {
  const run = await frameOf(method);
  const spent: number[] = [];
  for (let index = 0; index < warmUp + measured; index++) {
    const frame = actorFrame(index / rateHz, defaultCalibration);
    const begun = performance.now();
    await run(frame);
    if (index >= warmUp) spent.push(performance.now() - begun);
  }
  return { p10Ms: quantile(spent, 0.1), p50Ms: quantile(spent, 0.5) };
}

void reportOutcome(() => measure(new URLSearchParams(location.search).get('method') as TimedMethod));
