import type { Page } from '@playwright/test';
import { menuHeight, menuWidth } from '../../src/page/activity/activity-menu';
import { playerHeight } from '../../src/page/people/menu/players-sheet';
import { emulatedHeadset, frames, type Point } from '../emulated-headset';

/** A text drawn on one of the headset's sheets, and its position on the canvas [pixels]. */
export interface Written {
  readonly text: string;
  readonly x: number;
  readonly y: number;
  /** The width of the canvas, which differs between sheets. */
  readonly width: number;
}
declare global {
  interface Window {
    /** Set by `recordCanvasText`. */
    canvasTexts?: Written[];
  }
}

/** Records all text that is drawn on canvases; an init script that runs in the page. */
export function recordCanvasText(): void {
  const { fillText } = CanvasRenderingContext2D.prototype;
  const written: Written[] = [];
  window.canvasTexts = written;
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, ...rest) {
    written.push({ text, x, y, width: this.canvas.width });
    fillText.call(this, text, x, y, ...rest);
  };
}

/** Waits until a sheet of this width, by default the menu, shows a text; returns where it was drawn last. */
export async function waitForCanvasText(page: Page, text: string, width: number = menuWidth): Promise<Written> {
  const found = await page.waitForFunction(
    (wanted) => window.canvasTexts?.findLast(({ text, width }) => text === wanted.text && width === wanted.width),
    { text, width },
  );
  return (await found.jsonValue()) as Written;
}

/** The menu's centre [m] and yaw in the floor frame, as set in the page's shell/panels/vr-menu. */
const menuAt = [1.08, 1.3, -0.97] as const;
const menuYaw = -0.84;
/** The head pose that looks at the menu from a distance of 1 m. */
export const lookingAtMenu = {
  position: [menuAt[0] + Math.sin(menuYaw), 1.3, menuAt[2] + Math.cos(menuYaw)],
  orientation: [0, Math.sin(menuYaw / 2), 0, Math.cos(menuYaw / 2)],
} as const;

/** Returns a position of the menu's sheet in the floor frame, `ahead` in front of it [m]. */
export function menuPoint({ x, y }: Pick<Written, 'x' | 'y'>, ahead = 0): Point {
  const { sine, cosine } = { sine: Math.sin(menuYaw), cosine: Math.cos(menuYaw) };
  const right = (x - menuWidth / 2) / 1000;
  return [
    menuAt[0] + right * cosine + ahead * sine,
    menuAt[1] + (menuHeight / 2 - y) / 1000,
    menuAt[2] - right * sine + ahead * cosine,
  ];
}

/**
 * Pulls the right trigger while the controller points at this position of the menu's sheet from 40 cm in front of it.
 */
async function pullAt(page: Page, place: Written): Promise<void> {
  const headset = await emulatedHeadset(page);
  await headset.place({
    right: {
      position: menuPoint(place, 0.4),
      orientation: [0, Math.sin(menuYaw / 2), 0, Math.cos(menuYaw / 2)],
    },
  });
  await frames(page, 3);
  await headset.pull('right', 1);
  await frames(page, 3);
  await headset.pull('right', 0);
  await frames(page, 3);
}

/** Presses the item with this label on the headset's menu. */
export async function pressInMenu(page: Page, label: string): Promise<void> {
  await pullAt(page, await waitForCanvasText(page, label));
}

/** Presses the button with this label below this player's name in the menu's list of players, as drawn last. */
export async function pressBelow(page: Page, name: string, label: string): Promise<void> {
  const found = await page.waitForFunction(
    ({ name, label, playerHeight }) => {
      const written = window.canvasTexts ?? [];
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
