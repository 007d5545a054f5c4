import { estimatedJoints } from '../../body/joints';
import { readWeights, tensorOf } from './model-weights';
import { Perceptron } from './perceptron';
import type { FlatWeights, ModelContract, PoseRegressor } from './pose-regressor';

/**
 * The joints that the trunk network corrects, in its order: left and right shoulder, chest joint, hips; three numbers
 * each.
 */
const trunkOutputs = 12;
const outputs = 3 * estimatedJoints.length;
/** The smallest divisor: a trial run with zeros as inputs must not divide by zero. */
const shortestArm = 1e-3;

/** Returns the contract's entry for the weights of a run without a runtime; throws an Error if there is none. */
export function weightsOf({ name, weights }: ModelContract): FlatWeights {
  if (!weights) throw new Error(`${name}.json: names no weights for a run without a runtime`);
  return weights;
}

/**
 * The learned network without a runtime (training/threepoint_training/model.py, CorrectionNetwork): features in,
 * corrections of six joints out. A body and its mirror image go through the network together; the trunk's correction is
 * the mean of both, each arm is computed as a right one.
 */
class LearnedNetwork {
  readonly #features: number;
  /**
   * Arm network inputs: reach (3), its length (1), hand axes, IK elbow, up, seen. `armColumns` has the same count: it
   * lacks the computed length and ends with the arm length, used only as a divisor.
   */
  readonly #armInputs: number;
  readonly #trunk: Perceptron;
  readonly #arm: Perceptron;
  /** The feature index and the sign of each input, for the body and then for its mirror image. */
  readonly #columns: Int32Array;
  readonly #signs: Float64Array;
  readonly #armColumns: Int32Array;
  /** The inputs of both bodies before normalisation, from which the arm's inputs are read. */
  readonly #bodies: Float64Array;
  readonly #output = new Float32Array(outputs);

  /** Throws an Error if contract and file do not match. */
  constructor(contract: ModelContract, bytes: Uint8Array) {
    const stated = weightsOf(contract);
    const weights = readWeights(stated, bytes);
    const features = contract.inputs[0]?.shape.at(-1) ?? 0;
    this.#features = features;
    this.#trunk = new Perceptron(weights, 'trunk', features, trunkOutputs);
    this.#armInputs = weights.get('arm.inputMean')?.shape.at(-1) ?? 0;
    this.#arm = new Perceptron(weights, 'arm', this.#armInputs, 3);
    this.#columns = Int32Array.from(tensorOf(weights, 'mirrorColumns', 2 * features));
    this.#signs = Float64Array.from(tensorOf(weights, 'mirrorSigns', 2 * features));
    this.#armColumns = Int32Array.from(tensorOf(weights, 'armColumns', this.#armInputs));
    const outside = (column: number) => column < 0 || column >= features;
    if (this.#columns.some(outside) || this.#armColumns.some(outside)) {
      throw new Error(`${stated.file}: names columns beyond the ${features} features`);
    }
    this.#bodies = new Float64Array(2 * features);
  }

  /**
   * Returns the corrections of the six estimated joints [eye heights, chest frame], overwritten by the next run.
   * Allocates nothing.
   */
  run(features: Float32Array): Float32Array {
    const bodies = this.#bodies;
    for (let index = 0; index < bodies.length; index++) {
      bodies[index] = features[this.#columns[index]!]! * this.#signs[index]!;
    }
    this.#trunk.input.set(bodies);
    const trunk = this.#trunk.run();
    this.#correctTrunk(trunk, this.#trunk.stride);
    this.#fillArm(0, 3);
    this.#fillArm(1, 0);
    const arm = this.#arm.run();
    this.#correctElbows(arm, this.#arm.stride);
    return this.#output;
  }

  /** Averages the outputs for the body and its un-mirrored image; elbows start from their shoulder's correction. */
  #correctTrunk(trunk: Float64Array, image: number): void {
    const output = this.#output;
    for (let joint = 0; joint < 4; joint++) {
      // Left and right are swapped in the mirror image.
      const twin = joint < 2 ? 1 - joint : joint;
      for (let axis = 0; axis < 3; axis++) {
        const mirrored = (axis === 0 ? -1 : 1) * trunk[image + 3 * twin + axis]!;
        output[3 * (joint + 2) + axis] = (trunk[3 * joint + axis]! + mirrored) / 2;
      }
    }
    for (let index = 0; index < 6; index++) output[index] = output[6 + index]!;
  }

  /**
   * Writes the inputs of the right arm of the body (0) or of its mirror image (1). `shoulder`: the index of that
   * shoulder's correction.
   */
  #fillArm(body: 0 | 1, shoulder: 0 | 3): void {
    const from = body * this.#features;
    const inputs = this.#armInputs;
    const to = body * inputs;
    const { input } = this.#arm;
    const bodies = this.#bodies;
    const columns = this.#armColumns;
    const arm = Math.max(shortestArm, bodies[from + columns[inputs - 1]!]!);
    let squares = 0;
    for (let axis = 0; axis < 3; axis++) {
      const mirror = body === 1 && axis === 0 ? -1 : 1;
      const shift = mirror * this.#output[6 + shoulder + axis]!;
      const reach = bodies[from + columns[axis]!]! - shift / arm;
      input[to + axis] = reach;
      squares += reach * reach;
    }
    input[to + 3] = Math.sqrt(squares);
    for (let index = 4; index < inputs; index++) input[to + index] = bodies[from + columns[index - 1]!]!;
  }

  /** Adds each arm's correction to its elbow; the left one was computed as the right one of the image. */
  #correctElbows(arm: Float64Array, image: number): void {
    const output = this.#output;
    for (let axis = 0; axis < 3; axis++) {
      output[axis] = output[axis]! + (axis === 0 ? -1 : 1) * arm[image + axis]!;
      output[3 + axis] = output[3 + axis]! + arm[axis]!;
    }
  }
}

/** Runs the learned network on the calling thread within the frame, without a runtime or a worker. */
export function createPlainRegressor(contract: ModelContract, bytes: Uint8Array): PoseRegressor {
  const network = new LearnedNetwork(contract, bytes);
  return {
    contract,
    provider: 'plain',
    run: (features) => Promise.resolve(network.run(features).slice()),
    runNow: (features) => network.run(features),
    dispose: () => Promise.resolve(),
  };
}
