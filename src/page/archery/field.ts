import { walls, zone } from 'threepoint-games/archery/rules';

const back = Math.min(...walls.filter(({ axis }) => axis === 'z').map(({ at }) => at));

/** Where things of the range are, arena frame [m]: the archer stands about the origin and shoots along −Z. */
export const field = {
  /** Ropes run along both sides of the mown field. */
  halfWidth: 3.6,
  /** z behind the archer's back, and before the net behind the targets. */
  near: 2.4,
  far: back + 0.15,
  /** Width of a mown stripe. */
  stripe: 0.9,
  /** z of the net behind the targets. */
  back,
  /** Where the archer may stand. */
  zone,
} as const;
