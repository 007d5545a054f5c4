// "threepoint/three": draws the body as an avatar in three.js, driven by a WebXR session.
export type { Avatar } from '../avatar/avatar';
export type { BoneMap } from '../core/humanoid/bones';
export type { AvatarMotionOptions, AvatarSource, LoadAvatarOptions } from './avatar-source';
export { avatarMotionWriter, loadAvatar, loadMannequin } from './avatar-source';
export { BodyTracker, type BodyTrackerOptions } from './body-tracker';
