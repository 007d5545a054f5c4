import { fileURLToPath } from 'node:url';
import { expect, type Page } from '@playwright/test';
import { drawSeldom } from './draw-seldom';
import { type EmulatedHeadset, emulatedHeadset, type Placement } from './emulated-headset';

const iwer = fileURLToPath(new URL('../node_modules/iwer/build/iwer.min.js', import.meta.url));

/** The part of a three.js object that decides whether it is drawn. */
export interface Drawn {
  readonly visible: boolean;
  readonly parent: Drawn | null;
  readonly isScene?: true;
}

interface Coordinates {
  readonly x: number;
  readonly y: number;
  readonly z: number;
}

/** The library's BodyTracker, or its Body without an avatar, which every example leaves on the window. */
interface SelfAvatar {
  readonly pose: object | null;
  readonly object: Drawn;
  readonly estimator: string;
  readonly avatar?: { jointPositions(): Record<string, Coordinates> };
}

declare global {
  interface Window {
    selfAvatar?: SelfAvatar | null;
    /** The joints of a body without an avatar. */
    joints?: Record<string, { readonly position: Coordinates }>;
    /** The global of iwer's script. */
    IWER: {
      readonly metaQuest3: object;
      readonly XRDevice: new (config: object, options: object) => { installRuntime(options: object): void };
    };
  }
}

/** Returns the list to which the page's errors are added, and its warnings about a second copy of three.js. */
export function faultsOf(page: Page): readonly string[] {
  const faults: string[] = [];
  page.on('pageerror', ({ message }) => faults.push(message));
  page.on('console', (message) => {
    if (/multiple instances of three/i.test(message.text())) faults.push(message.text());
  });
  return faults;
}

/**
 * Warnings that are not about the library: of software rendering, of the emulator, of a class that react-three-fiber
 * uses, of models of controllers that Babylon.js and @react-three/xr fetch, of icons.
 */
const foreign =
  /GL Driver Message|GPU stall|THREE\.Clock|matching motion controller|input-profiles|loadProfile|offerSession|favicon\.ico/;

/** Returns the list to which the page's errors and all warnings of its console are added. */
export function complaintsOf(page: Page): readonly string[] {
  const complaints: string[] = [];
  page.on('pageerror', ({ message }) => complaints.push(message));
  page.on('console', (message) => {
    const text = `${message.text()} (${message.location().url})`;
    if (['warning', 'error'].includes(message.type()) && !foreign.test(text)) complaints.push(text);
  });
  return complaints;
}

/** Gives the page an emulated headset, from its next document on, and draws it seldom. */
export async function emulateHeadset(page: Page): Promise<void> {
  await drawSeldom(page);
  await page.addInitScript({ path: iwer });
  await page.addInitScript(() => {
    const device = new window.IWER.XRDevice(window.IWER.metaQuest3, { stereoEnabled: false });
    device.installRuntime({ forceInstall: true });
  });
}

/** Enters VR at this place and waits until the learned network draws the wearer's body. */
export async function enterExample(page: Page, placement: Placement): Promise<EmulatedHeadset> {
  await page.waitForFunction(() => window.selfAvatar);
  const headset = await emulatedHeadset(page);
  await headset.place(placement);
  await page.locator('#VRButton:not([disabled]), .a-enter-vr-button').first().click();
  await expect.poll(() => page.evaluate(() => window.selfAvatar?.pose != null)).toBe(true);
  await expect.poll(() => page.evaluate(() => window.selfAvatar?.estimator)).toBe('learned');
  return headset;
}

/** Returns the position of a joint of the wearer's own body [m, floor frame]. */
export const ownJoint = (page: Page, name: string): Promise<readonly [number, number, number]> =>
  page.evaluate((name) => {
    const at = window.joints?.[name]?.position ?? window.selfAvatar?.avatar?.jointPositions()[name];
    if (!at) throw new Error(`no ${name}`);
    return [at.x, at.y, at.z] as const;
  }, name);
