import { actorFrame, defaultCalibration } from 'threepoint/core';
import { expect, test, vi } from 'vitest';
import type { OpenActivity } from '../../../src/page/activity/activity';
import type { InputParts } from '../../../src/page/shell/input/input-parts';
import type { Controls } from '../../../src/page/shell/panels/controls';
import { FrameTiming } from '../../../src/page/shell/session/frame-timing';
import type { Headset } from '../../../src/page/shell/session/headset';
import { SessionChanges } from '../../../src/page/shell/session-changes';
import type { PassthroughHost } from '../../../src/page/shell/stage/passthrough-host';
import { Recorder } from '../../../src/page/studio/recorder';
import { fake } from './fake';

/**
 * A player in a match, with a headset to put on and a window that may lie behind others; `recorder`: keeps what is
 * tracked.
 */
function player(recorder = new Recorder()) {
  const page = Object.assign(new EventTarget(), { hidden: false });
  vi.stubGlobal('document', page);
  const headset = { pictureRateHz: 72, visibility: 'none' as Headset['visibility'] };
  let away = false;
  const nothing = () => undefined;
  const parts = fake<InputParts>({
    headset,
    recorder,
    timing: new FrameTiming(() => 0),
    stage: { view: { recentre: nothing } },
    body: { discontinuity: nothing },
    activities: {
      sessionChanged: nothing,
      current: {
        setAway(on: boolean) {
          away = on;
        },
      } as OpenActivity,
    },
    study: { run: null },
    onChange: nothing,
  });
  const controls = fake<Controls>({ show: nothing, setWorn: nothing, layOut: nothing });
  const changes = new SessionChanges(parts, controls, fake<PassthroughHost>({ sessionChanged: async () => undefined }));
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

test('a player whose session goes behind a device menu is away until it comes back', () => {
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

test('a recording made in a session ends with it: what moves the body afterwards is another', () => {
  const recorder = new Recorder();
  const { enter, leave } = player(recorder);
  const track = (time: number) => recorder.observe(actorFrame(time, defaultCalibration));
  enter();
  recorder.record({ device: 'headset', rateHz: 72, calibration: defaultCalibration });
  track(1);
  track(2);
  leave();
  track(3);
  expect([recorder.mode, recorder.frameCount]).toEqual(['idle', 2]);
});
