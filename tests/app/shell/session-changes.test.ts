import { afterEach, expect, test, vi } from 'vitest';
import { createFrameTiming } from '../../../src/app/shell/frame-timing';
import type { Headset } from '../../../src/app/shell/headset';
import { SessionChanges, type SessionChangesOptions } from '../../../src/app/shell/session-changes';

afterEach(() => vi.unstubAllGlobals());

/** A player in a match, with a headset to put on and a window that may lie behind others. */
function player() {
  const page = Object.assign(new EventTarget(), { hidden: false });
  vi.stubGlobal('document', page);
  const headset = { pictureRateHz: 72, visibility: 'none' as Headset['visibility'] };
  let away = false;
  const nothing = () => undefined;
  const play = {
    away(on: boolean) {
      away = on;
    },
  };
  const changes = new SessionChanges({
    headset,
    recorder: { stop: nothing },
    timing: createFrameTiming(() => 0),
    view: { view: 'third-person', setView: nothing } as unknown as SessionChangesOptions['view'],
    body: { begin: nothing, jumped: nothing },
    activities: { ball: { play } } as unknown as SessionChangesOptions['activities'],
    controls: { show: nothing, setWorn: nothing, layOut: nothing },
    study: { run: null },
  });
  changes.followWindow();
  return {
    isAway: () => away,
    setWindow(hidden: boolean) {
      page.hidden = hidden;
      page.dispatchEvent(new Event('visibilitychange'));
    },
    enter() {
      headset.visibility = 'visible';
      changes.entered();
    },
    setSession(state: XRVisibilityState) {
      headset.visibility = state;
      changes.visibilityChanged();
    },
    leave() {
      headset.visibility = 'none';
      changes.left();
    },
  };
}

test('a player whose session goes behind a menu of the device is away until it comes back', () => {
  const { enter, setSession, isAway } = player();
  enter();
  setSession('hidden');
  expect(isAway()).toBe(true);
  setSession('visible-blurred');
  expect(isAway()).toBe(false);
});

test('a player who leaves VR from a menu of the device is back at the window', () => {
  const { enter, setSession, leave, isAway } = player();
  enter();
  setSession('hidden');
  leave();
  expect(isAway()).toBe(false);
});

test('a player who wears the headset is there, whatever lies before the window', () => {
  const { enter, setWindow, leave, isAway } = player();
  enter();
  setWindow(true);
  expect(isAway()).toBe(false);
  leave();
  expect(isAway()).toBe(true);
  setWindow(false);
  expect(isAway()).toBe(false);
});
