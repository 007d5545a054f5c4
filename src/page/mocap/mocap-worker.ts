import { type FileBones, firstLine, reasonOf, UnknownBonesError } from 'threepoint/core';
import { isGltfMotion, readGltfMotion } from 'threepoint/files';
import { type MocapSource, type PreparedMocap, prepareMocap, sha256Base64Url } from 'threepoint/internal';
import { type FileKind, fileNameOf, readLimited } from 'threepoint-ui';
import type { GivenBones, MocapFile, MocapFiles } from './mocap-files';
import { isTable, purposeOfTable } from './table-files';

/** A request to the worker: the files to read. */
export type MocapRequest = MocapFiles & GivenBones;

/** The user's map of a file's bones. */
export interface MotionMap {
  /** The hash of the file that has the skeleton; null: the page cannot compute it, or a JSON map names the joints. */
  readonly hash: string | null;
  /** Whether the user's map was used. */
  readonly isUsed: boolean;
}

/**
 * A message of the worker: the progress [0, 1], the result, or the reason of a failure. `bones`: those that did not
 * match; null: the failure has another reason.
 */
export type MocapResponse =
  | { readonly fraction: number }
  | { readonly prepared: PreparedMocap; readonly map: MotionMap }
  | { readonly failure: string; readonly bones: FileBones | null; readonly hash: string | null };

const progressIntervalMs = 100;
const respond = (response: MocapResponse, transfer: Transferable[] = []): void =>
  self.postMessage(response, { transfer });

/** The largest file that is read: half an hour of all joints at 120 Hz. */
const mocapFile: FileKind = { what: 'a motion capture file', megabytes: 200 };
const bytesOf = (file: MocapFile): Promise<ArrayBuffer> => readLimited(file, mocapFile);
const named = (file: MocapFile, bytes: ArrayBuffer) => ({
  name: fileNameOf(file),
  text: new TextDecoder().decode(bytes),
});

/** Reads the files, and hashes the one that has the skeleton. */
async function sourceOf({ motion, skeleton, map }: MocapFiles) {
  const name = fileNameOf(motion);
  const bytes = await bytesOf(motion);
  if (isTable(name)) throw new Error(purposeOfTable(named(motion, bytes).text));
  const skeletonBytes = skeleton ? await bytesOf(skeleton) : bytes;
  const hash = map ? null : await sha256Base64Url(skeletonBytes);
  const mapped = map ? { map: named(map, await bytesOf(map)) } : {};
  const file: MocapSource = skeleton
    ? { format: 'amc', ...named(motion, bytes), skeleton: named(skeleton, skeletonBytes) }
    : isGltfMotion(name)
      ? { name, ...(await readGltfMotion(bytes, name)) }
      : { format: 'bvh', ...named(motion, bytes) };
  return { source: { ...file, ...mapped }, hash };
}

async function read({ bones, boneMaps, ...files }: MocapRequest): Promise<void> {
  const { source, hash } = await sourceOf(files);
  const userMap = bones ?? (hash === null ? undefined : boneMaps[hash]);
  const work = prepareMocap(userMap ? { ...source, bones: userMap } : source);
  try {
    const prepared = finish(work);
    const { clips } = prepared;
    respond(
      { prepared, map: { hash, isUsed: userMap !== undefined } },
      clips.flatMap(({ tracked, truth }) => [tracked.buffer, truth.buffer]),
    );
  } catch (error) {
    if (!(error instanceof UnknownBonesError)) throw error;
    const { joints, matched, confidence } = error;
    respond({ failure: firstLine(error.message), bones: { joints, matched, confidence }, hash });
  }
}

/** Finishes the work and reports its progress. */
function finish(work: Generator<number, PreparedMocap>): PreparedMocap {
  let reportedAt = 0;
  for (;;) {
    const step = work.next();
    if (step.done) return step.value;
    const now = performance.now();
    if (now - reportedAt < progressIntervalMs) continue;
    reportedAt = now;
    respond({ fraction: step.value });
  }
}

self.addEventListener('message', ({ data }: MessageEvent<MocapRequest>) => {
  read(data).catch((error: unknown) => respond({ failure: firstLine(reasonOf(error)), bones: null, hash: null }));
});
