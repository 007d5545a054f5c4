import type { BundledNetwork } from '../../src/threepoint/api/bundled/weights';
import type { ModelContract } from '../../src/threepoint/core/estimation/networks/pose-regressor';

/** Returns the learned network, which the published package contains as code that loads on demand. */
export async function readBundledNetwork(onProgress?: (fraction: number) => void): Promise<BundledNetwork> {
  const [{ default: contract }, { default: weights }] = await Promise.all([
    import('../../public/models/learned.json', { with: { type: 'json' } }),
    import('../../public/models/learned.bin'),
  ]);
  onProgress?.(1);
  return { contract: contract as unknown as ModelContract, weights };
}
