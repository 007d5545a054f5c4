import makeBasis from 'three/examples/jsm/libs/basis/basis_transcoder.js';
import { KTX2Loader } from 'three/examples/jsm/loaders/KTX2Loader.js';
import { reasonOf } from '../../core/errors/reasons';
import { functionOfText } from './basis-functions';

// three.js's own worker, which it otherwise writes as text into a blob: what the text would declare stands in the worker's scope instead, and
// `Function` compiles nothing.
const { EngineFormat, EngineType, TranscoderFormat, BasisFormat, BasisWorker } = KTX2Loader as unknown as Record<
  string,
  unknown
> & { BasisWorker(): void };
Object.assign(self, {
  BASIS: makeBasis,
  Function: functionOfText,
  _EngineFormat: EngineFormat,
  _EngineType: EngineType,
  _TranscoderFormat: TranscoderFormat,
  _BasisFormat: BasisFormat,
});

// A transcoder that does not start says nothing by itself.
self.addEventListener('unhandledrejection', ({ reason }) => {
  self.postMessage({ type: 'error', error: reasonOf(reason) });
});
BasisWorker();
