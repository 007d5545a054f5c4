import { DoubleSide } from 'three';

/**
 * For a transparent material that is visible from both sides. By default three.js draws one in two passes, back and
 * front, and looks its program up again for each (28 kB of garbage a frame for three nets before a mirror). A surface
 * that never covers itself needs only one pass.
 */
export const doubleSided = { side: DoubleSide, forceSinglePass: true } as const;
