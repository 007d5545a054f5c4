import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import * as ort from 'onnxruntime-web/wasm';
import { paperMethods } from '../../../../src/threepoint/core/estimation/methods/paper-methods';
import { createPlainRegressor } from '../../../../src/threepoint/core/estimation/networks/learned-network';
import type { ModelContract, PoseRegressor } from '../../../../src/threepoint/core/estimation/networks/pose-regressor';

export type NetworkName = ModelContract['name'];

/** The shipped contract of this name, and a file beside it that it speaks of. */
export function readShipped(name: NetworkName, part: 'graph' | 'weights' = 'graph') {
  const contract = JSON.parse(readFileSync(new URL(`${name}.json`, folder), 'utf8')) as ModelContract;
  const stated = part === 'graph' ? contract : contract.weights;
  if (!stated) throw new Error(`${name}.json names no weights`);
  const bytes = readFileSync(new URL(stated.file, folder));
  const sha256 = createHash('sha256').update(bytes).digest('hex');
  if (sha256 !== stated.sha256) throw new Error(`${stated.file}: its contract speaks of another file`);
  return { contract, bytes };
}

/** The learned network as it runs without a runtime. */
export function openPlainModel(): PoseRegressor {
  const { contract, bytes } = readShipped('learned', 'weights');
  return createPlainRegressor(contract, bytes);
}

const folder = new URL('../../../../public/models/', import.meta.url);

/** A model as the page ships it, run by the runtime that the page uses. */
export async function openShippedModel(name: NetworkName): Promise<PoseRegressor> {
  const { contract, bytes } = readShipped(name);
  ort.env.wasm.numThreads = 1;
  const session = await ort.InferenceSession.create(bytes, { executionProviders: ['wasm'] });
  const [input, output] = [contract.inputs[0]!, contract.outputs[0]!];
  const regressor: PoseRegressor = {
    contract,
    provider: 'wasm',
    async run(features) {
      const results = await session.run({ [input.name]: new ort.Tensor('float32', features, input.shape) });
      return results[output.name]!.data as Float32Array;
    },
    dispose: () => session.release(),
  };
  return name === 'paper' ? { ...regressor, methods: paperMethods(regressor) } : regressor;
}
