import type { Page } from '@playwright/test';
import type { EmulatedHeadset, Point, Rotation, Side } from './emulated-headset';
import { distance, expect, joint } from './page-fixture';

/** v rotated by q. */
function rotated([x, y, z, w]: Rotation, [vx, vy, vz]: Point): Point {
  const [tx, ty, tz] = [2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)];
  return [vx + w * tx + (y * tz - z * ty), vy + w * ty + (z * tx - x * tz), vz + w * tz + (x * ty - y * tx)];
}

/**
 * The wrist in the frame of the emulated controller's grip (Touch Plus) [m]: the middle of the fist lies 8 cm ahead of the wrist
 * and 2.5 cm towards the palm, and the handle leans 45° towards the fingers.
 */
const wristInGrip = {
  left: [-0.025, 0.08 * Math.SQRT1_2, 0.08 * Math.SQRT1_2],
  right: [0.025, 0.08 * Math.SQRT1_2, 0.08 * Math.SQRT1_2],
} as const;

export const wristName = { left: 'leftHand', right: 'rightHand' } as const;

/** Where the wrist must be: the grip as iwer has it, and how a hand holds it. */
export async function wristByGrip(headset: EmulatedHeadset, side: Side): Promise<Point> {
  const { position, orientation } = await headset.grip(side);
  const [x, y, z] = rotated(orientation, wristInGrip[side]);
  return [position[0] + x, position[1] + y, position[2] + z];
}

/** Waits until both wrists of the avatar, as drawn, lie where the controllers are held. */
export async function expectHandsOnControllers(page: Page, headset: EmulatedHeadset): Promise<void> {
  for (const side of ['left', 'right'] as const) {
    const wanted = await wristByGrip(headset, side);
    await expect
      .poll(async () => 1000 * distance(await joint(page, wristName[side]), wanted), {
        message: `the ${side} wrist lies within 1 mm of where the ${side} controller is held`,
      })
      .toBeLessThan(1);
  }
}
