import type { LoadNetwork } from 'threepoint';
import type { PaperMethod } from 'threepoint/core';
import { type Notices, pageFolder } from 'threepoint-ui';
import type { PageLoading } from './page-loading';
import type { Switches } from './switches';

const contractAt = (name: string): string => `${pageFolder()}/models/${name}.json`;
/** The share of the download in the time that a network takes to load. */
const downloadShare = 0.9;

/** Loads networks by name. The download of the runtime starts at once. */
export function createNetworkLoader(options: {
  readonly provider: Switches['ep'];
  readonly notices: Pick<Notices, 'show'>;
  readonly loading: Pick<PageLoading, 'report'>;
}): LoadNetwork<PaperMethod> {
  const { provider, notices, loading } = options;
  const networksArrive = import('threepoint/onnx').then(({ createInferenceWorker, onnxNetworks }) =>
    onnxNetworks({
      modelUrl: contractAt,
      provider,
      createWorker: createInferenceWorker,
      onProgress: (part) => loading.report('the network', downloadShare * part),
      onProviderFallback: (reason) => notices.show('warning', reason),
    }),
  );
  // If the download fails, each request for a network reports it.
  networksArrive.catch(() => undefined);
  return async (name) => (await networksArrive)(name);
}
