/** What a body from a file may cost: several times what avatars made for headsets have, far below what stalls one. */
export const avatarLimits = {
  megabytes: 60,
  triangles: 250_000,
  /** Pictures, the length of their longer side, and all their pixels together. */
  textures: 64,
  texturePixels: 4096,
  millionPixels: 96,
  bones: 600,
  nodes: 4000,
  /** Morph targets of all primitives together. */
  morphTargets: 4000,
  /** Numbers in all accessors together, unpacked. */
  millionNumbers: 40,
} as const;
export type AvatarLimits = Readonly<Record<keyof typeof avatarLimits, number>>;

/** What a body may cost that another person has on: there are several of them, and no one here has chosen them. */
export const seenAvatarLimits: AvatarLimits = {
  megabytes: 20,
  triangles: 100_000,
  textures: 48,
  texturePixels: 4096,
  millionPixels: 64,
  bones: 400,
  nodes: 2000,
  morphTargets: 1000,
  millionNumbers: 12,
};
