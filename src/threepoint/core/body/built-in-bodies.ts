/**
 * The bodies that every page has a file of, by name; the first is the default, and the body of everybody in a study.
 */
export const builtInBodies = ['mannequin', 'woman', 'man', 'stout', 'child'] as const;
export type BuiltInBody = (typeof builtInBodies)[number];

/** The skin tones, lightest first. The mannequin has none; without a tone a body keeps the one of its file. */
export const skinTones = ['fair', 'light', 'beige', 'tan', 'brown', 'dark'] as const;
export type SkinTone = (typeof skinTones)[number];

/** The name of a built-in body, followed by a dash and its skin tone. */
export type BuiltInAvatar = BuiltInBody | `${BuiltInBody}-${SkinTone}`;

interface Look {
  readonly body: BuiltInBody;
  readonly tone: SkinTone | null;
}

const looks: ReadonlyMap<string, Look> = new Map(
  builtInBodies.flatMap((body): [BuiltInAvatar, Look][] => [
    [body, { body, tone: null }],
    ...(body === builtInBodies[0]
      ? []
      : skinTones.map((tone): [BuiltInAvatar, Look] => [`${body}-${tone}`, { body, tone }])),
  ]),
);

export const isBuiltInAvatar = (name: unknown): name is BuiltInAvatar => typeof name === 'string' && looks.has(name);

/** Returns the name of this body in this tone; the body alone where it has no skin or no tone is given. */
export function builtInAvatarOf(body: BuiltInBody, tone: SkinTone | undefined): BuiltInAvatar {
  const name = `${body}-${tone}`;
  return isBuiltInAvatar(name) ? name : body;
}

export const bodyOf = (avatar: BuiltInAvatar): BuiltInBody => looks.get(avatar)?.body ?? builtInBodies[0];

/** Returns the skin tone; null: that of the body's file. */
export const skinToneOf = (avatar: BuiltInAvatar): SkinTone | null => looks.get(avatar)?.tone ?? null;

export const plainAvatar: BuiltInBody = builtInBodies[0];
