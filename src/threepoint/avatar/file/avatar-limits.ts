/**
 * The limits of an avatar's file: several times the size of avatars made for headsets, and far below a size that stalls
 * one.
 */
export const avatarLimits = {
  megabytes: 60,
  triangles: 250_000,
  /** Images, the length of their longer side, and all their pixels together. */
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

/** The limits of another person's avatar: several are drawn at a time, and this page's user has not chosen them. */
export const untrustedAvatarLimits: AvatarLimits = {
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
