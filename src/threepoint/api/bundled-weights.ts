import { fetchFile, type StatedFile } from '../onnx/model-files';

/**
 * Returns the weights of the learned network that this package brings. In the repository they are a file next to the
 * page; in the published package a module with the same bytes takes the place of this one, so that no bundler can lose
 * them (scripts/build-library.mjs).
 */
export const readBundledWeights = (stated: StatedFile, onProgress?: (share: number) => void): Promise<Uint8Array> =>
  fetchFile(new URL('../../../public/models/learned.bin', import.meta.url).href, stated, onProgress);
