import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import * as ort from 'onnxruntime-web/wasm';
import type { ModelContract, PoseRegressor } from '../../../src/core/estimation/pose-regressor';

const folder = new URL('../../../public/models/', import.meta.url);

export type NetworkName = ModelContract['name'];

/** A model as the page ships it, run by the runtime that the page uses. */
export async function openShippedModel(name: NetworkName): Promise<PoseRegressor> {
  const contract = JSON.parse(readFileSync(new URL(`${name}.json`, folder), 'utf8')) as ModelContract;
  const bytes = readFileSync(new URL(contract.file, folder));
  const sha256 = createHash('sha256').update(bytes).digest('hex');
  if (sha256 !== contract.sha256) throw new Error(`${contract.file}: its contract speaks of another file`);
  ort.env.wasm.numThreads = 1;
  const session = await ort.InferenceSession.create(bytes, { executionProviders: ['wasm'] });
  const [input, output] = [contract.inputs[0]!, contract.outputs[0]!];
  return {
    contract,
    provider: 'wasm',
    async run(features) {
      const results = await session.run({ [input.name]: new ort.Tensor('float32', features, input.shape) });
      return results[output.name]!.data as Float32Array;
    },
    dispose: () => session.release(),
  };
}
