import { chunksOf } from '../../avatar/glb-chunks';
import { firstLine, reasonOf } from '../../core/errors/reasons';
import { type MocapSource, type PreparedMocap, prepareMocap } from '../../core/mocap/prepare-mocap';
import type { MocapFiles } from './mocap-files';

/** What the worker says: how far it is [0, 1], what it read, or why it could not. */
export type MocapAnswer =
  | { readonly share: number }
  | { readonly prepared: PreparedMocap }
  | { readonly refused: string };

const tellEveryMs = 100;
const tell = (answer: MocapAnswer, transfer: Transferable[] = []): void => self.postMessage(answer, { transfer });

const textOf = (bytes: ArrayBuffer): string => new TextDecoder().decode(bytes);

function sourceOf({ motion, skeleton }: MocapFiles): MocapSource {
  const { name, bytes } = motion;
  if (skeleton) {
    const bones = { name: skeleton.name, text: textOf(skeleton.bytes) };
    return { format: 'amc', name, text: textOf(bytes), skeleton: bones };
  }
  if (!/\.vrma$/i.test(name)) return { format: 'bvh', name, text: textOf(bytes) };
  const chunks = chunksOf(new Uint8Array(bytes));
  if (!chunks) throw new Error(`${name}: no VRM Animation: it is no GLB file, or cut short`);
  try {
    return { format: 'vrma', name, description: JSON.parse(chunks.json), binary: chunks.binary };
  } catch (error) {
    throw new Error(`${name}: its description is no JSON: ${reasonOf(error)}`);
  }
}

self.addEventListener('message', ({ data: files }: MessageEvent<MocapFiles>) => {
  try {
    const work = prepareMocap(sourceOf(files));
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
  } catch (error) {
    tell({ refused: firstLine(reasonOf(error)) });
  }
});
