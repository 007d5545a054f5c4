import type { Page } from '@playwright/test';
import { menuHeight, menuWidth } from 'threepoint-page/activity/activity-menu';
import { playerHeight } from 'threepoint-page/ball/players-sheet';
import { emulatedHeadset, frames } from './emulated-headset';

/** What is written on the sheets of the headset, and where on its canvas [pixels]. */
interface Written {
  readonly text: string;
  readonly x: number;
  readonly y: number;
}
declare global {
  interface Window {
    /** Put there by `keepWritten`. */
    writtenOnCanvases?: Written[];
  }
}

/** In the page, before anything of it: canvases tell a test what is written on them from then on. */
export function keepWritten(): void {
  const { fillText } = CanvasRenderingContext2D.prototype;
  const written: Written[] = [];
  window.writtenOnCanvases = written;
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, ...rest) {
    written.push({ text, x, y });
    fillText.call(this, text, x, y, ...rest);
  };
}

export const writtenAs = (page: Page, text: string) =>
  page.waitForFunction((wanted) => window.writtenOnCanvases?.findLast(({ text }) => text === wanted), text);

/** The menu's middle [m] and its yaw, floor frame (app/shell/vr-menu/vr-menu.ts); eyes that look at it from a metre away. */
const menuAt = [1.1, 1.3, -1.15] as const;
const menuYaw = -0.74;
export const lookingAtMenu = {
  position: [menuAt[0] + Math.sin(menuYaw), 1.3, menuAt[2] + Math.cos(menuYaw)],
  orientation: [0, Math.sin(menuYaw / 2), 0, Math.cos(menuYaw / 2)],
} as const;

/** Pulls the right trigger at this place of the menu's sheet: 40 cm before it, straight at it. */
async function pullAt(page: Page, { x, y }: Written): Promise<void> {
  const headset = await emulatedHeadset(page);
  const { sine, cosine } = { sine: Math.sin(menuYaw), cosine: Math.cos(menuYaw) };
  const right = (x - menuWidth / 2) / 1000;
  await headset.place({
    right: {
      position: [
        menuAt[0] + right * cosine + 0.4 * sine,
        menuAt[1] + (menuHeight / 2 - y) / 1000,
        menuAt[2] - right * sine + 0.4 * cosine,
      ],
      orientation: [0, Math.sin(menuYaw / 2), 0, Math.cos(menuYaw / 2)],
    },
  });
  await frames(page, 3);
  await headset.pull('right', 1);
  await frames(page, 3);
  await headset.pull('right', 0);
  await frames(page, 3);
}

/** Presses what has this word on the menu in the headset. */
export async function pressInMenu(page: Page, label: string): Promise<void> {
  await pullAt(page, (await (await writtenAs(page, label)).jsonValue()) as Written);
}

/** Presses the button with this word that stands below this name in the menu's list of the other players, as it was drawn last. */
export async function pressBelow(page: Page, name: string, label: string): Promise<void> {
  const found = await page.waitForFunction(
    ({ name, label, playerHeight }) => {
      const written = window.writtenOnCanvases ?? [];
      const list = written.slice(written.findLastIndex(({ text }) => text === 'Other players'));
      const named = list.find(({ text }) => text === name);
      const below = list.slice(
        0,
        list.findIndex(({ text }) => text === 'Close'),
      );
      return named && below.find(({ text, y }) => text === label && y > named.y && y < named.y + playerHeight);
    },
    { name, label, playerHeight },
  );
  await pullAt(page, (await found.jsonValue()) as Written);
}
