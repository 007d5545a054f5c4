// "threepoint/files": reads files of avatars and motions step by step, for pages that check them, correct their bones
// or decode compressed ones.
export type { CheckedAvatar } from '../avatar/file/check-avatar';
export { checkInWorker } from '../avatar/file/check-in-worker';
export { MotionOnlyError } from '../avatar/file/motion-only-error';
export { isGltfMotion, readGltfMotion } from '../avatar/file/read-gltf-motion';
export { type ReadBones, readFileBones } from '../avatar/humanoid/read-file-bones';
export { withNamedBones } from '../avatar/humanoid/write-bone-names';
export { type Decoders, parseAvatar, parseChecked } from '../avatar/load-avatar';
export { loadUntrustedAvatar } from '../avatar/load-untrusted-avatar';
