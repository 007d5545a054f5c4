// Imports are of single modules, and those with three.js wait for a file that needs them: this process starts for each
// reading, in tests of the training some forty times.
import type { MocapSource } from 'threepoint/internal';
import { reasonOf } from '../../src/threepoint/core/errors/reasons';
import { prepareMocap, readTruthMotion } from '../../src/threepoint/core/mocap/prepare-mocap';
import { finishWork } from '../../src/threepoint/core/motion/work';
import type { FileBytes, ReaderApi, ReaderResponse } from './reader-process';

async function sourceOf({ name, bytes, skeleton, ...more }: FileBytes): Promise<MocapSource> {
  if (!/\.(amc|bvh)$/i.test(name)) {
    const { readGltfMotion } = await import('threepoint/files');
    return { name, ...more, ...(await readGltfMotion(bytes, name)) };
  }
  const text = new TextDecoder().decode(bytes);
  return skeleton ? { format: 'amc', name, text, skeleton, ...more } : { format: 'bvh', name, text, ...more };
}

const reader: ReaderApi = {
  clips: async (file) => finishWork(prepareMocap(await sourceOf(file))).clips,
  truth: async (file) => finishWork(readTruthMotion(await sourceOf(file))),
  async avatar({ name, bytes }) {
    const { checkAvatar } = await import('../../src/threepoint/avatar/file/check-avatar');
    return (await checkAvatar(bytes, { name, supportedCompressions: [] })).file.arrayBuffer();
  },
};

const respond = (response: ReaderResponse): void => void process.send!(response);

process.on('message', ({ call, file }: { readonly call: keyof ReaderApi; readonly file: FileBytes }) => {
  reader[call](file).then(
    (read) => respond({ read }),
    (error: unknown) => respond({ refused: reasonOf(error) }),
  );
});
