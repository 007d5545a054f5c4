// The learned estimator alone, by one way to run its network (?way=…): what a page without graphics pays for it.

import { actorFrame, defaultCalibration } from 'threepoint/core';
import { nextTurn } from '../../src/threepoint/api/run-work';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import { createWithNetwork } from '../../src/threepoint/core/estimation/with-network';
import { quantile } from '../../src/threepoint/core/math/statistics';
import type { NetworkCost, NetworkWay } from '../networks';
import { reportOutcome } from './outcome';

/** Frames that are measured, after those in which the engine compiles. */
const measured = 600;
const warmUp = 300;

async function load(way: NetworkWay): Promise<PoseRegressor> {
  const contractUrl = '/models/learned.json';
  if (way === 'plain') {
    const { loadPlainRegressor } = await import('../../src/threepoint/onnx/load-plain-regressor');
    return loadPlainRegressor(contractUrl);
  }
  const [{ loadRegressor }, { createInferenceWorker }] = await Promise.all([
    import('../../src/threepoint/onnx/load-regressor'),
    import('../../src/threepoint/onnx/create-inference-worker'),
  ]);
  return loadRegressor(
    contractUrl,
    way === 'webgpu' ? { provider: 'webgpu' } : { createWorker: createInferenceWorker },
  );
}

async function measure(way: NetworkWay): Promise<NetworkCost> {
  const opened = performance.now();
  const regressor = await load(way);
  const estimator = createWithNetwork('learned', defaultCalibration, regressor);
  const inFrame: number[] = [];
  const onThread: number[] = [];
  let firstBodyMs = Number.NaN;
  for (let frame = 0; frame < warmUp + measured; frame++) {
    const timeMs = await new Promise<number>(requestAnimationFrame);
    const tracked = actorFrame(timeMs / 1000, defaultCalibration);
    const begun = performance.now();
    const { request } = estimator.update(tracked);
    const spent = performance.now() - begun;
    // A frame that draws the network's own answer, not inverse kinematics alone.
    const { network } = estimator.source;
    if (Number.isNaN(firstBodyMs) && network?.answer(estimator.state.solved)) firstBodyMs = performance.now() - opened;
    let later = 0;
    if (request) {
      await nextTurn();
      const asked = performance.now();
      void request.ask();
      later = performance.now() - asked;
    }
    if (frame < warmUp) continue;
    inFrame.push(spent);
    onThread.push(spent + later);
  }
  const at = (values: readonly number[], share: number) => Number(quantile(values, share).toFixed(4));
  const summary = (values: readonly number[]) => ({ p50: at(values, 0.5), p95: at(values, 0.95) });
  const device = regressor.provider === 'webgpu' ? ` (${await graphicsDevice()})` : '';
  return {
    provider: `${regressor.provider}${device}`,
    inFrameMs: summary(inFrame),
    threadMs: summary(onThread),
    firstBodyMs,
  };
}

/** What WebGPU computes on, in the browser's words. */
async function graphicsDevice(): Promise<string> {
  const { gpu } = navigator as unknown as {
    readonly gpu?: { requestAdapter(): Promise<{ readonly info: Readonly<Record<string, string>> } | null> };
  };
  const { vendor, architecture, description } = (await gpu?.requestAdapter())?.info ?? {};
  return [vendor, architecture, description].filter(Boolean).join(' ') || 'unnamed';
}

void reportOutcome(() => measure(new URLSearchParams(location.search).get('way') as NetworkWay));
