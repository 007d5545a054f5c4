// "threepoint/files": reads files of avatars and motions step by step, for pages that check them, correct their bones
// or decode compressed ones.
import { createWorkerCheck } from '../avatar/file/avatar-check-client';
import type { AvatarCheck } from '../avatar/file/check-avatar';
import type { readFileBones as readNow } from '../avatar/humanoid/read-file-bones';
import { startValidator } from './bundled/validator';

export type { CheckedAvatar } from '../avatar/file/check-avatar';
export { MotionOnlyError } from '../avatar/file/motion-only-error';
export { isGltfMotion, readGltfMotion } from '../avatar/file/read-gltf-motion';
export type { ReadBones } from '../avatar/humanoid/read-file-bones';
export { withNamedBones } from '../avatar/humanoid/write-bone-names';
export { type Decoders, parseAvatar, parseChecked } from '../avatar/load-avatar';
export { loadUntrustedAvatar } from '../avatar/load-untrusted-avatar';

/** Checks a file in a worker of this page; if none starts, the file is refused. */
export const checkInWorker: AvatarCheck = /* @__PURE__ */ createWorkerCheck(startValidator, async (_, { name }) => {
  throw new Error(`${name}: could not be checked (the validator did not start)`);
});

/**
 * Reads the bones of a checked file and matches them: by a VRM's humanoid, else by the matcher, which is loaded with
 * the first file. Rejects with an Error that names the file.
 */
export const readFileBones: typeof readNow = async (...file) =>
  (await import('../avatar/humanoid/read-file-bones')).readFileBones(...file);
