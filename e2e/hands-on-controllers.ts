import type { Page } from '@playwright/test';
import type { EmulatedHeadset, Point, Rotation, Side } from './emulated-headset';
import { distance, expect, joint } from './page-fixture';

/** Returns v rotated by q. */
function rotated([x, y, z, w]: Rotation, [vx, vy, vz]: Point): Point {
  const [tx, ty, tz] = [2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)];
  return [vx + w * tx + (y * tz - z * ty), vy + w * ty + (z * tx - x * tz), vz + w * tz + (x * ty - y * tx)];
}

/**
 * The wrist in the grip frame of the emulated controller (Touch Plus) [m]. The centre of the fist lies 8 cm in front of
 * the wrist and 2.5 cm towards the palm; the handle is tilted by 45° towards the fingers.
 */
const wristInGrip = {
  left: [-0.025, 0.08 * Math.SQRT1_2, 0.08 * Math.SQRT1_2],
  right: [0.025, 0.08 * Math.SQRT1_2, 0.08 * Math.SQRT1_2],
} as const;

export const wristName = { left: 'leftHand', right: 'rightHand' } as const;

/** Returns the expected position of the wrist [m, floor frame], from iwer's grip pose and `wristInGrip`. */
export async function wristByGrip(headset: EmulatedHeadset, side: Side): Promise<Point> {
  const { position, orientation } = await headset.grip(side);
  const [x, y, z] = rotated(orientation, wristInGrip[side]);
  return [position[0] + x, position[1] + y, position[2] + z];
}

/** Waits until both wrists of the drawn avatar are within 1 mm of their expected positions on the controllers. */
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
