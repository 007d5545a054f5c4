import type { ModelContract, PoseRegressor } from '../src/threepoint/core/estimation/networks/pose-regressor';
import { startRegressor } from '../src/threepoint/onnx/load-regressor';
import { windowInputs } from './evaluate/window-source';

/** The networks of the field that the board compares with ours. */
export const fieldNetworks = ['transformer', 'memory'] as const;
type FieldNetwork = (typeof fieldNetworks)[number];

export const isFieldNetwork = (method: string): method is FieldNetwork =>
  fieldNetworks.some((network) => network === method);

/** The methods of docs/board.md with a body, in its order. */
const boardMethods = ['ccd', 'ik', 'paper', 'learned', ...fieldNetworks] as const;
export type BoardMethod = (typeof boardMethods)[number];

/** The methods whose frames are timed in a browser, and the time until a frame has its body. */
export const timedMethods = ['hands-only', ...boardMethods] as const;
export type TimedMethod = (typeof timedMethods)[number];
export interface BoardTime {
  /** A tenth of the frames are faster: what a machine without other work needs. */
  readonly p10Ms: number;
  readonly p50Ms: number;
}

/** Starts a network over windows. `beside`: the contract of a network of the same training. */
export const startFieldNetwork = (beside: ModelContract, model: Uint8Array): Promise<PoseRegressor> =>
  startRegressor(
    {
      ...beside,
      inputs: [
        { ...beside.inputs[0]!, name: 'window', shape: [1, windowInputs], meaning: 'window', unit: 'eyeHeight' },
      ],
      outputs: [{ ...beside.outputs[0]!, name: 'joints', meaning: 'joints', unit: 'eyeHeight', frame: 'heading' }],
    },
    model,
  );
