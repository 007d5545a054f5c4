import type { Calibration } from '../../body/calibration';
import type { PipelineOptions } from '../pipeline';
import type { PaperMethod, PoseEstimator } from '../pose-estimator';

/** One tensor of a model, as its contract file states it. */
interface TensorContract {
  readonly name: string;
  readonly shape: readonly number[];
  /** A description of the numbers: quantities, frames, order. */
  readonly meaning: string;
  /** 'm', 'rad', '1' or a ratio such as 'eyeHeight'. */
  readonly unit: string;
  /** The frame of the numbers. chest: IK's chest in the newest frame. */
  readonly frame: 'heading' | 'chest';
}

/**
 * A model's numbers in one flat file, for a forward pass without a runtime
 * (training/threepoint_training/flat_weights.py).
 */
export interface FlatWeights {
  /** File name beside the contract, its size and SHA-256 (hex). */
  readonly file: string;
  readonly bytes: number;
  readonly sha256: string;
  /** The type and shape of each tensor, such as `int8 192 176`, in the order of the file. */
  readonly tensors: Readonly<Record<string, string>>;
}

/** The contract beside each model file: its input and output, training data and accuracy. */
export interface ModelContract {
  readonly name: 'paper' | 'learned';
  readonly version: string;
  /** File name beside the contract, its size and SHA-256 (hex). */
  readonly file: string;
  readonly bytes: number;
  readonly sha256: string;
  readonly inputs: readonly TensorContract[];
  readonly outputs: readonly TensorContract[];
  /** The frame rate of the training motion [Hz]. */
  readonly rateHz: number;
  /** Ages [s] of the frames in the input, newest first: [0] for a single frame. */
  readonly windowSeconds: readonly number[];
  readonly quantisation: { readonly scheme: string; readonly maxAbsoluteDifference: number };
  readonly trainedOn: { readonly corpus: string; readonly corpusHash: string; readonly people: readonly string[] };
  readonly gitCommit: string;
  readonly seed: number;
  /** MPJPE [cm] by protocol and joint, as measured by the training run (docs/training.md). */
  readonly errors: Readonly<Record<string, Readonly<Record<string, number>>>>;
  /** The weights for a run without a runtime; absent: the model needs one. */
  readonly weights?: FlatWeights;
}

/** Creates an estimator of one method, with its network. */
export type EstimatorFactory = (calibration: Calibration, options: PipelineOptions) => PoseEstimator;

/** A network that maps one flat feature vector to one flat output vector. */
export interface PoseRegressor {
  readonly contract: ModelContract;
  /** The backend: 'wasm', 'webgpu' or 'plain' (without a runtime). */
  readonly provider: string;
  /**
   * Runs the network. `features`: as many numbers as the input tensor has elements; do not change them until the
   * promise settles. Resolves to the output tensor's numbers. Rejects if the runtime fails. One run at a time.
   */
  run(features: Float32Array): Promise<Float32Array>;
  /**
   * Runs the network synchronously, so that a frame has its own result; absent if it runs on another thread or device.
   * The next run overwrites the numbers.
   */
  readonly runNow?: (features: Float32Array) => Float32Array;
  /** The methods that need this network and that a body without it does not contain. */
  readonly methods?: Readonly<Record<PaperMethod, EstimatorFactory>> | undefined;
  dispose(): Promise<void>;
}
