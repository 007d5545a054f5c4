/** Where things of the range are, arena frame [m]: the archer stands about the origin and shoots along −Z. */
export const field = {
  /** Ropes run along both sides. */
  halfWidth: 3.6,
  /** z behind the archer's back and before the backstop. */
  near: 2.4,
  far: -12.4,
  /** Width of a mown stripe. */
  stripe: 0.9,
  /** The net behind the targets. */
  net: { z: -12.5, halfWidth: 4.6, height: 3 },
  /** Where the archer may stand. */
  zone: { width: 1.1, depth: 1 },
} as const;
