import { walls, zone } from 'threepoint-games/archery';

const back = Math.min(...walls.filter(({ axis }) => axis === 'z').map(({ at }) => at));

/** Positions on the range, arena frame [m]. The archer stands around the origin and shoots along −Z. */
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
  /** The zone in which the archer may stand. */
  zone,
} as const;
