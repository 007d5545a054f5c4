import { wakeSound } from 'threepoint-page/shell/wake-sound';
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';

let page = new EventTarget();
let userActivation = { hasBeenActive: false };
beforeEach(() => {
  page = new EventTarget();
  userActivation = { hasBeenActive: false };
  vi.stubGlobal('window', page);
  vi.stubGlobal('navigator', { userActivation });
});
afterEach(() => vi.unstubAllGlobals());

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
  test('wakes with the first touch or key, and with no other', () => {
    const sound = gameSound();
    wakeSound(sound, true, notices);
    expect(sound.times()).toBe(0);
    press(['pointerdown', 'pointerup', 'keydown', 'pointerdown', 'keydown']);
    expect(sound.times()).toBe(1);
  });

  test('wakes when a finger is lifted, which counts, not when it comes down', () => {
    const sound = gameSound();
    wakeSound(sound, true, notices);
    press(['keydown', 'pointerdown'], false);
    expect(sound.times()).toBe(0);
    press(['pointerup']);
    expect(sound.times()).toBe(1);
  });

  test('stays asleep once the game is left', () => {
    const sound = gameSound();
    const leave = wakeSound(sound, true, notices);
    leave();
    press(['pointerdown', 'keydown']);
    expect(sound.times()).toBe(0);
  });
});
