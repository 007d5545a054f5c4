import { type LoadNetwork, loadLearned } from 'threepoint';
import type { PaperMethod } from 'threepoint/core';
import { type Notices, pageFolder } from 'threepoint-ui';
import type { PageLoading } from './page-loading';
import type { Switches } from './switches';

const contractAt = (name: string): string => `${pageFolder()}/models/${name}.json`;
/** The share of the download in the time that a network takes to load. */
const downloadShare = 0.9;

/**
 * Returns a loader of networks by name; each runs in a worker. The learned network needs no runtime, unless the address
 * asks for a provider. The paper's needs onnxruntime-web, which is downloaded on the first request.
 */
export function createNetworkLoader(options: {
  readonly provider: Switches['ep'];
  readonly notices: Pick<Notices, 'show'>;
  readonly loading: Pick<PageLoading, 'report'>;
}): LoadNetwork<PaperMethod> {
  const { provider, notices, loading } = options;
  const onProgress = (part: number) => loading.report('the network', downloadShare * part);
  const loadersArrive = import('threepoint/onnx').then(({ createInferenceWorker: createWorker, onnxNetworks }) => ({
    plain: () => loadLearned({ onProgress, createWorker }),
    withRuntime: onnxNetworks({
      modelUrl: contractAt,
      provider: provider ?? 'wasm',
      createWorker,
      onProgress,
      onProviderFallback: (reason) => notices.show('warning', reason),
    }),
  }));
  // If the download fails, each request for a network reports it.
  loadersArrive.catch(() => undefined);
  return async (name) => {
    const { plain, withRuntime } = await loadersArrive;
    return name === 'learned' && provider === null ? plain() : withRuntime(name);
  };
}
