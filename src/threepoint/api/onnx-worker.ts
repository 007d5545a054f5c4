// "threepoint/onnx-worker": the module of the worker that `createWorker` creates.
import '../onnx/inference-worker';
