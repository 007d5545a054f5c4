import { BodySolver } from 'threepoint';
import { actorFrame, defaultCalibration } from 'threepoint/core';
import { expect, test, vi } from 'vitest';
import type { OpenActivity } from '../../../src/page/activity/activity';
import { FrameTiming } from '../../../src/page/shell/frame-timing';
import type { Headset } from '../../../src/page/shell/headset';
import { SessionChanges, type SessionChangesOptions } from '../../../src/page/shell/session/session-changes';
import { Recorder } from '../../../src/page/studio/recorder';

const noNetworks = () => Promise.reject(new Error('inverse kinematics needs no network'));

/**
 * A player in a match, with a headset to put on and a window that may lie behind others; `recorder`: keeps what is
 * tracked.
 */
function player(recorder = new Recorder()) {
  const page = Object.assign(new EventTarget(), { hidden: false });
  vi.stubGlobal('document', page);
  const headset = { pictureRateHz: 72, visibility: 'none' as Headset['visibility'] };
  let away = false;
  const body = new BodySolver({ estimator: 'ik', calibration: defaultCalibration, networks: noNetworks });
  const nothing = () => undefined;
  const changes = new SessionChanges({
    headset,
    recorder,
    timing: new FrameTiming(() => 0),
    stage: { view: { view: 'third-person', setView: nothing } } as unknown as SessionChangesOptions['stage'],
    body,
    activities: {
      sessionChanged: nothing,
      current: {
        setAway(on: boolean) {
          away = on;
        },
      } as OpenActivity,
    },
    controls: { show: nothing, setWorn: nothing, layOut: nothing },
    study: { run: null },
    passthrough: { sessionChanged: async () => undefined },
  });
  changes.followWindow();
  return {
    body,
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

test('the body of a session ends with it: the headset’s pose and lost hands are gone', () => {
  const { body, enter, leave } = player();
  enter();
  body.tick(1000);
  expect(body.update(actorFrame(1, defaultCalibration))).not.toBeNull();
  leave();
  expect(body.pose).toBeNull();
});
