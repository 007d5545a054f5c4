// "threepoint/onnx-worker": what a worker of `createWorker` runs.
import '../inference/inference-worker';
