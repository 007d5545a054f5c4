/**
 * The names of the bodies that come with every page. The first is the plain one: it replaces an avatar that is missing,
 * and all participants of a study have it.
 */
export const builtInBodies = ['mannequin', 'woman', 'man', 'stout', 'child'] as const;
export type BuiltInBody = (typeof builtInBodies)[number];

/** The skin tones, lightest first. The mannequin has none; without a tone a body keeps that of its file. */
export const skinTones = ['fair', 'light', 'beige', 'tan', 'brown', 'dark'] as const;
export type SkinTone = (typeof skinTones)[number];

/** The name of a built-in body, followed by a dash and its skin tone. */
export type BuiltInAvatar = BuiltInBody | `${BuiltInBody}-${SkinTone}`;

interface BodyAndTone {
  readonly body: BuiltInBody;
  readonly tone: SkinTone | null;
}

const bodiesAndTones: ReadonlyMap<string, BodyAndTone> = new Map(
  builtInBodies.flatMap((body): [BuiltInAvatar, BodyAndTone][] => [
    [body, { body, tone: null }],
    ...(body === builtInBodies[0]
      ? []
      : skinTones.map((tone): [BuiltInAvatar, BodyAndTone] => [`${body}-${tone}`, { body, tone }])),
  ]),
);

export const isBuiltInAvatar = (name: unknown): name is BuiltInAvatar =>
  typeof name === 'string' && bodiesAndTones.has(name);

/** Returns the name of a body with a skin tone; the body's name alone if it has no skin or no tone is given. */
export function builtInAvatarOf(body: BuiltInBody, tone: SkinTone | undefined): BuiltInAvatar {
  const name = `${body}-${tone}`;
  return isBuiltInAvatar(name) ? name : body;
}

export const bodyOf = (avatar: BuiltInAvatar): BuiltInBody => bodiesAndTones.get(avatar)?.body ?? builtInBodies[0];

/** Returns the skin tone; null: that of the body's file. */
export const skinToneOf = (avatar: BuiltInAvatar): SkinTone | null => bodiesAndTones.get(avatar)?.tone ?? null;

export const defaultAvatar: BuiltInBody = builtInBodies[0];
