import { ballsPerRack, rackPosition } from 'threepoint-games/ball';

/** Positions on the court, arena frame [m]. The throwers stand around the origin and throw along −Z. */
export const court = {
  /** The painted ground, and the lane between throwers and holder. */
  halfWidth: 3.4,
  near: 2.1,
  far: -7.2,
  laneHalfWidth: 1.75,
  laneNear: 0.95,
  laneFar: -6.1,
  /** The radius of each player's mark. */
  padRadius: 0.46,
  /**
   * One board for the throwers, one for the holder, who is further away from it. They hang high enough that no name
   * label hides a line.
   */
  boards: [
    { z: -9.4, turned: 0, width: 3.1, middle: 3.8 },
    { z: 6.6, turned: Math.PI, width: 3.7, middle: 4.5 },
  ],
} as const;

/** Middle and size of a rack's tray [m]. */
export function trayOf(side: 0 | 1, balls: number) {
  const perRack = ballsPerRack(balls);
  const slots = Array.from({ length: perRack }, (_, slot) => rackPosition(side * perRack + slot, balls));
  const xs = slots.map(({ x }) => x);
  const zs = slots.map(({ z }) => z);
  const middle = (values: readonly number[]) => (Math.min(...values) + Math.max(...values)) / 2;
  const spread = (values: readonly number[]) => Math.max(...values) - Math.min(...values);
  return { x: middle(xs), z: middle(zs), width: spread(xs) + 0.2, depth: spread(zs) + 0.2, y: slots[0]?.y ?? 0.925 };
}
