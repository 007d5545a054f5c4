/** Bodies that every page has a file of, by name; the first is worn by those who say nothing, and by all in a study. */
export const ownAvatars = ['mannequin', 'woman', 'man', 'stout', 'child'] as const;
export type OwnAvatar = (typeof ownAvatars)[number];

export const isOwnAvatar = (name: unknown): name is OwnAvatar => ownAvatars.some((own) => own === name);

/** The SHA-256 of a file of no more than `mostAvatarBytes`, as base64url without padding: 43 characters, which no own avatar's name has. */
export type AvatarHash = string;

/** What a player has on to the others: a body of our own by its name, or a file by its content. */
export type WornAvatar = OwnAvatar | AvatarHash;

export const plainAvatar: OwnAvatar = ownAvatars[0];

/** How the SHA-256 of a file is written. */
export const avatarHash = /^[\w-]{43}$/;

/** An avatar that is seen by others has a file of this size at most [bytes]. */
export const mostAvatarBytes = 20 * 2 ** 20;

/** Whether this is the content of a file, and no name. */
export const isAvatarHash = (avatar: WornAvatar): avatar is AvatarHash => avatarHash.test(avatar);
