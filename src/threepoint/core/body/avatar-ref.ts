import type { BuiltInAvatar } from './built-in-bodies';

/**
 * The SHA-256 of an avatar's file as base64url without padding: 43 characters, unlike any name of a built-in avatar.
 */
export type AvatarHash = string;

/** The avatar that others see: a built-in body by its name, or a file by its content. */
export type AvatarRef = BuiltInAvatar | AvatarHash;

/** The form of a file's SHA-256. */
export const avatarHashPattern = /^[\w-]{43}$/;

/** The largest file of an avatar that others see [bytes]. */
export const maxAvatarBytes = 20 * 2 ** 20;
