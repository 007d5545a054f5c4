// "threepoint/onnx-worker": what a worker of `createWorker` runs.
import '../inference/inference-worker';

// A module without exports would have no types.
export {};
