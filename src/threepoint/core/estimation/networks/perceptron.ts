import { type Tensor, tensorOf } from './model-weights';

/** The number of outputs that one pass over the inputs computes, so that each input is read once for all of them. */
const rowsAtOnce = 4;
/** The largest input in standard deviations of the training data; larger ones are clamped. */
const maxDeviations = 4;

/** One layer's weights as its loop reads them. */
interface Layer {
  readonly inputs: number;
  readonly rows: number;
  /** `rows`, rounded up to a multiple of `rowsAtOnce`: nothing reads the outputs beyond. */
  readonly outputs: number;
  /** For each block of `rowsAtOnce` outputs, the weights input by input. */
  readonly weights: Float32Array;
  readonly bias: Float64Array;
  /** Its outputs for both inputs, one behind the other. */
  readonly results: Float64Array;
}

/**
 * A multilayer perceptron with ELU between its layers, computed for two inputs at once: each weight is read once for
 * both. Sums are 64 bits wide, weights the 32-bit numbers of the ONNX graph.
 */
export class Perceptron {
  /** Both inputs, one behind the other, to be filled before `run`. */
  readonly input: Float64Array;
  readonly #inputs: number;
  readonly #mean: Float64Array;
  readonly #inverseScale: Float64Array;
  readonly #layers: readonly Layer[];

  /** `name`: the prefix of its tensors. */
  constructor(weights: ReadonlyMap<string, Tensor>, name: string, inputs: number, outputs: number) {
    this.#inputs = inputs;
    this.input = new Float64Array(2 * inputs);
    this.#mean = Float64Array.from(tensorOf(weights, `${name}.inputMean`, inputs));
    this.#inverseScale = Float64Array.from(tensorOf(weights, `${name}.inputScale`, inputs), (scale) =>
      Math.fround(1 / scale),
    );
    const layers: Layer[] = [];
    for (let given = inputs; ; given = layers.at(-1)!.rows) {
      const layer = `${name}.${layers.length}`;
      const rows = weights.get(`${layer}.bias`)?.shape[0];
      if (rows === undefined) break;
      layers.push(readLayer(weights, layer, given, rows));
    }
    const rows = layers.at(-1)?.rows ?? 0;
    if (rows !== outputs) throw new Error(`${name} has ${rows} outputs, expected ${outputs}`);
    this.#layers = layers;
  }

  /** Distance in the result of `run` from the outputs of the first input to those of the second. */
  get stride(): number {
    return this.#layers.at(-1)!.outputs;
  }

  /** Both outputs, overwritten by the next run. The input is overwritten too. */
  run(): Float64Array {
    this.#normalise();
    let given = this.input;
    let stride = this.#inputs;
    const last = this.#layers.length - 1;
    for (let index = 0; index <= last; index++) {
      const layer = this.#layers[index]!;
      applyLayer(layer, given, stride);
      given = layer.results;
      stride = layer.outputs;
      if (index < last) elu(given);
    }
    return given;
  }

  #normalise(): void {
    const count = this.#inputs;
    for (let index = 0; index < 2 * count; index++) {
      const column = index < count ? index : index - count;
      const deviations = (this.input[index]! - this.#mean[column]!) * this.#inverseScale[column]!;
      this.input[index] = Math.min(maxDeviations, Math.max(-maxDeviations, deviations));
    }
  }
}

function readLayer(weights: ReadonlyMap<string, Tensor>, name: string, inputs: number, rows: number): Layer {
  const outputs = rowsAtOnce * Math.ceil(rows / rowsAtOnce);
  const exact = weights.has(`${name}.weights`);
  const values = tensorOf(weights, `${name}.${exact ? 'weights' : 'levels'}`, rows, inputs);
  const scale = exact ? null : tensorOf(weights, `${name}.scale`, rows);
  const interleaved = new Float32Array(outputs * inputs);
  for (let row = 0; row < rows; row++) {
    const block = row - (row % rowsAtOnce);
    for (let column = 0; column < inputs; column++) {
      interleaved[block * inputs + column * rowsAtOnce + (row - block)] =
        values[row * inputs + column]! * (scale ? scale[row]! : 1);
    }
  }
  const bias = new Float64Array(outputs);
  bias.set(tensorOf(weights, `${name}.bias`, rows));
  return { inputs, rows, outputs, weights: interleaved, bias, results: new Float64Array(2 * outputs) };
}

/** Applies a layer. `given`: both inputs, the second at offset `stride`. */
function applyLayer({ inputs, outputs, weights, bias, results }: Layer, given: Float64Array, stride: number): void {
  let at = 0;
  for (let row = 0; row < outputs; row += rowsAtOnce) {
    let a0 = bias[row]!;
    let a1 = bias[row + 1]!;
    let a2 = bias[row + 2]!;
    let a3 = bias[row + 3]!;
    let b0 = a0;
    let b1 = a1;
    let b2 = a2;
    let b3 = a3;
    for (let column = 0; column < inputs; column++) {
      const a = given[column]!;
      const b = given[stride + column]!;
      const w0 = weights[at]!;
      const w1 = weights[at + 1]!;
      const w2 = weights[at + 2]!;
      const w3 = weights[at + 3]!;
      at += rowsAtOnce;
      a0 += w0 * a;
      a1 += w1 * a;
      a2 += w2 * a;
      a3 += w3 * a;
      b0 += w0 * b;
      b1 += w1 * b;
      b2 += w2 * b;
      b3 += w3 * b;
    }
    results[row] = a0;
    results[row + 1] = a1;
    results[row + 2] = a2;
    results[row + 3] = a3;
    results[outputs + row] = b0;
    results[outputs + row + 1] = b1;
    results[outputs + row + 2] = b2;
    results[outputs + row + 3] = b3;
  }
}

function elu(values: Float64Array): void {
  for (let index = 0; index < values.length; index++) {
    const value = values[index]!;
    if (value < 0) values[index] = Math.expm1(value);
  }
}
