import { clamp } from 'threepoint/math';

/** Distance from the arrow rest to the middle of the string at rest [m]. */
export const braceHeight = 0.16;

/** The longest draw beyond brace height, and the shortest that shoots [m]. */
export const maximumDraw = 0.7;
export const minimumDraw = 0.15;

/** Length from nock to tip [m]: at full draw the tip still lies ahead of the grip. */
export const arrowLength = 0.88;

/** Height of the arrow rest above the centre of the fist [m]. */
export const arrowRestHeight = 0.035;

/** Stiffness of the bow [N/m]: 140 N (31 pounds) at full draw. */
export const stiffness = 200;
/** Mass of an arrow [kg], and the share of the bow's energy that it receives. */
export const arrowMass = 0.025;
export const efficiency = 0.72;

/**
 * Returns the speed [m/s] of an arrow after this draw [m]: ½·m·v² = η·½·k·x², a linear spring, so v is proportional to
 * the draw (75.9 /s). The draw is clamped to [0, maximumDraw].
 */
export const arrowSpeed = (draw: number): number =>
  clamp(draw, 0, maximumDraw) * Math.sqrt((efficiency * stiffness) / arrowMass);
