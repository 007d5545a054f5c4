// "threepoint/onnx-worker": what a worker of `createWorker` runs.
import '../onnx/inference-worker';
