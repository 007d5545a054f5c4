import { type FileEntry, fetchFile } from '../../onnx/model-files';

/** Returns the learned network's weights. The published package has scripts/library/embedded-weights.ts instead. */
export const readBundledWeights = (stated: FileEntry, onProgress?: (fraction: number) => void): Promise<Uint8Array> =>
  fetchFile(new URL('../../../../public/models/learned.bin', import.meta.url).href, stated, onProgress);
