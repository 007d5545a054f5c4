import type { Page } from '@playwright/test';
import { fromAxisAngle, multiply, right, up } from 'threepoint/math';
import { lobbySize } from '../../src/page/people/view/lobby-sheet';
import { type EmulatedHeadset, frames, type Point, type Rotation, type Side } from '../emulated-headset';
import { menuPoint, waitForCanvasText } from './hands-on-menu';

/** Returns the orientation whose −Z points from one place to another. */
export function pointingFrom(from: Point, to: Point): Rotation {
  const [x, y, z] = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
  const yaw = fromAxisAngle(up, Math.atan2(-x, -z));
  const { x: a, y: b, z: c, w } = multiply(yaw, fromAxisAngle(right, Math.atan2(y, Math.hypot(x, z))));
  return [a, b, c, w];
}

/** Returns where the item with this label lies, floor frame; waits until the menu shows it. */
export async function inMenu(page: Page, label: string): Promise<Point> {
  return menuPoint(await waitForCanvasText(page, label));
}

/**
 * Returns where the button with this label lies on the ball game's sheet for eyes at 1.6 m, floor frame; waits until
 * the sheet shows it. Its place and size are set in the page's ball/view/lobby-sheet.
 */
export async function inLobby(page: Page, label: string): Promise<Point> {
  const { width, height } = lobbySize;
  const { x, y } = await waitForCanvasText(page, label, width);
  const metres = 1.3 / width;
  return [(x - width / 2) * metres, 1.44 + (height / 2 - y) * metres, -1.9];
}

/** Pinches with a bare hand that points at a place from here, for a number of frames. */
export async function pinchAt(
  page: Page,
  headset: EmulatedHeadset,
  {
    side,
    from,
    to,
    held = 3,
  }: { readonly side: Side; readonly from: Point; readonly to: Point; readonly held?: number },
): Promise<void> {
  await headset.place({ [side]: { position: from, orientation: pointingFrom(from, to) } });
  await frames(page, 3);
  await headset.pinch(side, 1);
  await frames(page, held);
  await headset.pinch(side, 0);
  await frames(page, 3);
}

/** The sources that a page of tests adds to the emulated headset. */
declare global {
  interface Window {
    /** Set by `pinchByEyes`. */
    eyePinch?: { begin(): void; end(): void };
  }
}

/**
 * Turns the emulated headset into one that reports no hands, but a pinch while it lasts (`transient-pointer`, as Safari
 * on Vision Pro): the right controller's ray is that of the eyes. Call it in a session.
 */
export const pinchByEyes = (page: Page): Promise<void> =>
  page.evaluate(() => {
    const device = window.emulatedDevice;
    const { inputSource } = device.controllers.right as unknown as { inputSource: XRInputSource };
    const pinch = Object.create(inputSource, {
      targetRayMode: { value: 'transient-pointer' },
      profiles: { value: ['generic-hand-select', 'generic-trigger'] },
      gamepad: { value: undefined },
    }) as XRInputSource;
    let there: readonly XRInputSource[] = [];
    Object.defineProperty(device, 'inputSources', { get: () => there });
    const fire = (type: string) =>
      device.activeSession?.dispatchEvent(Object.assign(new Event(type), { frame: null, inputSource: pinch }));
    window.eyePinch = {
      begin() {
        there = [pinch];
        fire('selectstart');
      },
      end() {
        fire('selectend');
        fire('select');
        there = [];
      },
    };
  });
