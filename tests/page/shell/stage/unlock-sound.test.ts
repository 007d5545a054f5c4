import { beforeEach, describe, expect, test, vi } from 'vitest';
import { unlockSound } from '../../../../src/page/shell/stage/unlock-sound';

let page = new EventTarget();
let pageDocument = Object.assign(new EventTarget(), { visibilityState: 'visible' });
let userActivation = { hasBeenActive: false };
beforeEach(() => {
  page = new EventTarget();
  userActivation = { hasBeenActive: false };
  vi.stubGlobal('window', page);
  pageDocument = Object.assign(new EventTarget(), { visibilityState: 'visible' });
  vi.stubGlobal('document', pageDocument);
  vi.stubGlobal('navigator', { userActivation });
});

/** `counts`: whether the browser takes the first of them for a touch of the page. */
const press = (types: readonly string[], counts = true) => {
  userActivation.hasBeenActive ||= counts;
  for (const type of types) page.dispatchEvent(new Event(type));
};
const notices = { show: () => undefined };

function gameSound() {
  let unlocked = 0;
  return {
    setMuted: () => undefined,
    async unlock() {
      unlocked += 1;
    },
    times: () => unlocked,
  };
}

describe('the sound of a game on a page that no one has touched', () => {
  test('wakes with the first touch or key', () => {
    const sound = gameSound();
    unlockSound(sound, true, notices);
    expect(sound.times()).toBe(0);
    press(['pointerdown']);
    expect(sound.times()).toBe(1);
  });

  test('wakes when a finger is lifted, which counts, not when it comes down', () => {
    const sound = gameSound();
    unlockSound(sound, true, notices);
    press(['keydown', 'pointerdown'], false);
    expect(sound.times()).toBe(0);
    press(['pointerup']);
    expect(sound.times()).toBe(1);
  });

  test('stays asleep once the game is left', () => {
    const sound = gameSound();
    const leave = unlockSound(sound, true, notices);
    leave();
    press(['pointerdown', 'keydown']);
    expect(sound.times()).toBe(0);
  });
});

test('sound that cannot start after its game was left is no notice', async () => {
  const shown: string[] = [];
  const failing = { setMuted: () => undefined, unlock: () => Promise.reject(new Error('the audio is closed')) };
  userActivation.hasBeenActive = true;
  const silentNotices = { show: (_kind: string, text: string) => void shown.push(text) };
  unlockSound(failing, true, silentNotices)();
  await Promise.resolve();
  expect(shown).toEqual([]);
  unlockSound(failing, true, silentNotices);
  await Promise.resolve();
  expect(shown).toEqual(['Sound could not be started: the audio is closed']);
});

describe('the sound of a game that the system has suspended', () => {
  test('wakes with each touch, and when the page is seen again', () => {
    const sound = gameSound();
    userActivation.hasBeenActive = true;
    unlockSound(sound, true, notices);
    expect(sound.times()).toBe(1);
    press(['pointerup']);
    expect(sound.times()).toBe(2);
    pageDocument.visibilityState = 'hidden';
    pageDocument.dispatchEvent(new Event('visibilitychange'));
    expect(sound.times()).toBe(2);
    pageDocument.visibilityState = 'visible';
    pageDocument.dispatchEvent(new Event('visibilitychange'));
    expect(sound.times()).toBe(3);
  });

  test('is reported once where it cannot start, however often it is touched', async () => {
    const shown: string[] = [];
    const sound = { setMuted: () => undefined, unlock: () => Promise.reject(new Error('no audio device')) };
    userActivation.hasBeenActive = true;
    unlockSound(sound, true, { show: (_, text) => shown.push(text) });
    press(['pointerup']);
    press(['pointerup']);
    await vi.waitFor(() => expect(shown).toEqual(['Sound could not be started: no audio device']));
  });

  test('stays asleep where it is off, or once the game is left', () => {
    const sound = gameSound();
    userActivation.hasBeenActive = true;
    unlockSound(sound, false, notices);
    const leave = unlockSound(sound, true, notices);
    leave();
    press(['pointerup']);
    pageDocument.dispatchEvent(new Event('visibilitychange'));
    expect(sound.times()).toBe(1);
  });
});
