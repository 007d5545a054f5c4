import { DoubleSide } from 'three';

/**
 * For a transparent material that is seen from both sides. three.js draws one in two passes, back and front, unless told otherwise, and looks
 * its program up anew for each (28 kB of garbage a frame for three nets before a mirror). What does not lie before itself needs but one.
 */
export const bothSides = { side: DoubleSide, forceSinglePass: true } as const;
