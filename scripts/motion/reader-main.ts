import { reasonOf } from 'threepoint/core';
import { isGltfMotion, readGltfMotion } from 'threepoint/files';
import { type MocapSource, prepareMocap } from 'threepoint/motion';
import { checkAvatar } from '../../src/threepoint/avatar/file/check-avatar';
import { readTruthMotion } from '../../src/threepoint/core/mocap/prepare-mocap';
import { finishWork } from '../../src/threepoint/core/motion/work';
import type { FileBytes, ReaderApi, ReaderResponse } from './reader-process';

async function sourceOf({ name, bytes, skeleton, ...more }: FileBytes): Promise<MocapSource> {
  if (isGltfMotion(name)) return { name, ...more, ...(await readGltfMotion(bytes, name)) };
  const text = new TextDecoder().decode(bytes);
  return skeleton ? { format: 'amc', name, text, skeleton, ...more } : { format: 'bvh', name, text, ...more };
}

const reader: ReaderApi = {
  clips: async (file) => finishWork(prepareMocap(await sourceOf(file))).clips,
  truth: async (file) => finishWork(readTruthMotion(await sourceOf(file))),
  avatar: async ({ name, bytes }) => (await checkAvatar(bytes, { name, supportedCompressions: [] })).file.arrayBuffer(),
};

const respond = (response: ReaderResponse): void => void process.send!(response);

process.on('message', ({ call, file }: { readonly call: keyof ReaderApi; readonly file: FileBytes }) => {
  reader[call](file).then(
    (read) => respond({ read }),
    (error: unknown) => respond({ refused: reasonOf(error) }),
  );
});
