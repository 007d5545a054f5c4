import contract from '../../../../public/models/learned.json' with { type: 'json' };
import { weightsOf } from '../../core/estimation/networks/learned-network';
import type { ModelContract } from '../../core/estimation/networks/pose-regressor';
import { fetchFile } from '../../onnx/model-files';

export interface BundledNetwork {
  readonly contract: ModelContract;
  readonly weights: Uint8Array;
}

const own = contract as unknown as ModelContract;

/** Returns the learned network. The published package has scripts/library/embedded-weights.ts instead. */
export async function readBundledNetwork(onProgress?: (fraction: number) => void): Promise<BundledNetwork> {
  const { href } = new URL('../../../../public/models/learned.bin', import.meta.url);
  return { contract: own, weights: await fetchFile(href, weightsOf(own), onProgress) };
}
