/**
 * The bodies that every page has a file of, by name; the first is the default, and the body of everybody in a study.
 */
export const ownBodies = ['mannequin', 'woman', 'man', 'stout', 'child'] as const;
export type OwnBody = (typeof ownBodies)[number];

/** The skin tones, lightest first. The mannequin has none; without a tone a body keeps the one of its file. */
export const skinTones = ['fair', 'light', 'beige', 'tan', 'brown', 'dark'] as const;
export type SkinTone = (typeof skinTones)[number];

/** The name of one of the project's own bodies, followed by a dash and its skin tone. */
export type OwnAvatar = OwnBody | `${OwnBody}-${SkinTone}`;

interface Look {
  readonly body: OwnBody;
  readonly tone: SkinTone | null;
}

const looks: ReadonlyMap<string, Look> = new Map(
  ownBodies.flatMap((body): [OwnAvatar, Look][] => [
    [body, { body, tone: null }],
    ...(body === ownBodies[0] ? [] : skinTones.map((tone): [OwnAvatar, Look] => [`${body}-${tone}`, { body, tone }])),
  ]),
);

export const isOwnAvatar = (name: unknown): name is OwnAvatar => typeof name === 'string' && looks.has(name);

/** Returns the name of this body in this tone; the body alone where it has no skin or no tone is given. */
export function ownAvatarOf(body: OwnBody, tone: SkinTone | undefined): OwnAvatar {
  const name = `${body}-${tone}`;
  return isOwnAvatar(name) ? name : body;
}

export const bodyOf = (avatar: OwnAvatar): OwnBody => looks.get(avatar)?.body ?? ownBodies[0];

/** Returns the skin tone; null: that of the body's file. */
export const skinToneOf = (avatar: OwnAvatar): SkinTone | null => looks.get(avatar)?.tone ?? null;

/** The SHA-256 of an avatar's file as base64url without padding: 43 characters, unlike any name of an own avatar. */
export type AvatarHash = string;

/** The avatar that others see: one of the project's own bodies by its name, or a file by its content. */
export type AvatarRef = OwnAvatar | AvatarHash;

export const plainAvatar: OwnBody = ownBodies[0];

/** The form of a file's SHA-256. */
export const avatarHash = /^[\w-]{43}$/;

/** The largest file of an avatar that others see [bytes]. */
export const mostAvatarBytes = 20 * 2 ** 20;

/** Returns whether this is the hash of a file, and not a name. */
export const isAvatarHash = (avatar: AvatarRef): avatar is AvatarHash => avatarHash.test(avatar);
