/** Bodies that every page has a file of, by name; the first is worn by those who say nothing, and by all in a study. */
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

/** What this body in this tone is called; the mannequin, which has no skin, and a person of no tone by the body alone. */
export function ownAvatarOf(body: OwnBody, tone: SkinTone | undefined): OwnAvatar {
  const name = `${body}-${tone}`;
  return isOwnAvatar(name) ? name : body;
}

export const bodyOf = (avatar: OwnAvatar): OwnBody => looks.get(avatar)?.body ?? ownBodies[0];

/** null: as the body's file has it. */
export const skinToneOf = (avatar: OwnAvatar): SkinTone | null => looks.get(avatar)?.tone ?? null;

/** The SHA-256 of a file of no more than `mostAvatarBytes`, as base64url without padding: 43 characters, which no own avatar's name has. */
export type AvatarHash = string;

/** What a player has on to the others: a body of our own by its name, or a file by its content. */
export type AvatarRef = OwnAvatar | AvatarHash;

export const plainAvatar: OwnBody = ownBodies[0];

/** How the SHA-256 of a file is written. */
export const avatarHash = /^[\w-]{43}$/;

/** An avatar that is seen by others has a file of this size at most [bytes]. */
export const mostAvatarBytes = 20 * 2 ** 20;

/** Whether this is the content of a file, and no name. */
export const isAvatarHash = (avatar: AvatarRef): avatar is AvatarHash => avatarHash.test(avatar);
