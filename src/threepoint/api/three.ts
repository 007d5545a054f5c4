// "threepoint/three": draws the body as an avatar in three.js, driven by a WebXR session.
export { type Avatar, createAvatar, createAvatarBetweenFrames } from '../avatar/avatar';
export { bodyLabelOf, bodyLabels } from '../avatar/built-in-body-labels';
export { ContactShadow } from '../avatar/contact-shadow';
export { createDebugSkeleton } from '../avatar/debug-skeleton';
export { showToEyesOnly } from '../avatar/eye-layers';
export { GazeChoice, GazeTargets } from '../avatar/gaze-targets';
export { fingersFromButtons, handShapeFromButtons } from '../avatar/hands/button-fingers';
export { ObjectHolds } from '../avatar/hands/hold-object';
export { createHeadLossFade } from '../avatar/head-loss-fade';
export { Mirror } from '../avatar/mirror';
export { palettes, skinColors } from '../avatar/palettes';
export { RemoteAvatars } from '../avatar/remote-avatars';
export { thirdPersonOnlyLayer } from '../avatar/rig/body-meshes';
export { type ClothWeave, weaveCloth } from '../avatar/rig/cloth-weave';
export type { BoneMap } from '../core/humanoid/bones';
export type { AvatarMotionOptions, AvatarSource, LoadAvatarOptions } from './avatar-source';
export { avatarMotionWriter, loadAvatar, loadMannequin } from './avatar-source';
export { BodyTracker, type BodyTrackerOptions } from './body-tracker';
