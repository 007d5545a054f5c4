import { isGltfMotion, readGltfMotion } from 'threepoint/avatar/file/read-gltf-motion';
import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import { type MocapSource, type PreparedMocap, prepareMocap } from 'threepoint/core/mocap/prepare-mocap';
import { type FileKind, fileNameOf, readLimited } from 'threepoint-ui/limited-files';
import type { MocapFile, MocapFiles } from './mocap-files';

/** The worker's messages: progress [0, 1], the result, or the reason of a failure. */
export type MocapAnswer =
  | { readonly share: number }
  | { readonly prepared: PreparedMocap }
  | { readonly refused: string };

const tellEveryMs = 100;
const tell = (answer: MocapAnswer, transfer: Transferable[] = []): void => self.postMessage(answer, { transfer });

/** What the readers take; half an hour of all joints at 120 Hz. */
const mocapFile: FileKind = { what: 'a motion capture file', megabytes: 200 };
const bytesOf = (file: MocapFile): Promise<ArrayBuffer> => readLimited(file, mocapFile);
const textOf = async (file: MocapFile): Promise<string> => new TextDecoder().decode(await bytesOf(file));

const named = async (file: MocapFile) => ({ name: fileNameOf(file), text: await textOf(file) });

async function sourceOf({ motion, skeleton, map }: MocapFiles): Promise<MocapSource> {
  const name = fileNameOf(motion);
  const mapped = map ? { map: await named(map) } : {};
  if (skeleton) return { format: 'amc', ...(await named(motion)), skeleton: await named(skeleton), ...mapped };
  if (isGltfMotion(name)) return { name, ...(await readGltfMotion(await bytesOf(motion), name)), ...mapped };
  return { format: 'bvh', ...(await named(motion)), ...mapped };
}

async function read(files: MocapFiles): Promise<void> {
  const work = prepareMocap(await sourceOf(files));
  let told = 0;
  for (;;) {
    const step = work.next();
    if (step.done) {
      const { clips } = step.value;
      return tell(
        { prepared: step.value },
        clips.flatMap(({ tracked, truth }) => [tracked.buffer, truth.buffer]),
      );
    }
    const now = performance.now();
    if (now - told < tellEveryMs) continue;
    told = now;
    tell({ share: step.value });
  }
}

self.addEventListener('message', ({ data: files }: MessageEvent<MocapFiles>) => {
  read(files).catch((error: unknown) => tell({ refused: firstLine(reasonOf(error)) }));
});
