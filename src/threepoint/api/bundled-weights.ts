import { type FileEntry, fetchFile } from '../onnx/model-files';

/**
 * Returns the weights of the learned network. In the repository they are fetched; the published package replaces this
 * module by one that contains the bytes, because some bundlers drop files (scripts/build-library.mjs).
 */
export const readBundledWeights = (stated: FileEntry, onProgress?: (share: number) => void): Promise<Uint8Array> =>
  fetchFile(new URL('../../../public/models/learned.bin', import.meta.url).href, stated, onProgress);
