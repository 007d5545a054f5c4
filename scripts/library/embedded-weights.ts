import type { FileEntry } from '../../src/threepoint/onnx/model-files';

/** Returns the weights of the learned network, which the published package contains as code. */
export async function readBundledWeights(_: FileEntry, onProgress?: (share: number) => void): Promise<Uint8Array> {
  const { default: weights } = await import('../../public/models/learned.bin');
  onProgress?.(1);
  return weights;
}
