import type { PoseRegressor } from '../../core/estimation/pose-regressor';
import { createInferenceWorker } from '../../inference/create-inference-worker';
import type { Notices } from '../../ui/notices';
import { pageFolder } from '../../ui/page-folder';
import { withTiming } from './frame-loop';
import type { FrameTiming } from './frame-timing';
import type { PageLoading } from './page-loading';
import type { Switches } from './switches';

/** Where our own networks lie: beside the page. */
const contractAt = (name: string): string => `${pageFolder()}/models/${name}.json`;
/** Of the waiting for a network, what its download takes. */
const downloadShare = 0.9;

export interface NetworkLoadingOptions {
  readonly provider: Switches['executionProvider'];
  readonly timing: FrameTiming;
  readonly notices: Pick<Notices, 'show'>;
  readonly loading: Pick<PageLoading, 'report'>;
}

/** Loads networks by name. The code that runs them is asked for at once. */
export function createNetworkLoader(options: NetworkLoadingOptions): (name: string) => Promise<PoseRegressor> {
  const { provider, timing, notices, loading } = options;
  const inferenceArrives = import('../../inference/load-regressor');
  // Where it does not come, each network that is asked for says so.
  inferenceArrives.catch(() => undefined);
  return async (name) => {
    const { loadRegressor } = await inferenceArrives;
    const loaded = await loadRegressor(contractAt(name), {
      provider,
      createWorker: createInferenceWorker,
      onProgress: (part) => loading.report('the network', downloadShare * part),
      onProviderFallback: (reason) => notices.show('warning', reason),
    });
    return withTiming(loaded, timing);
  };
}
