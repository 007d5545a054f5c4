import { type AvatarPose, actorFrame, defaultCalibration, nothingPressed, type TrackingFrame } from 'threepoint/core';
import { GazeTargets } from 'threepoint/internal/three';
import { identity, type Vec3, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import type { InputParts } from '../../../src/page/shell/input/input-parts';
import { PageFrame } from '../../../src/page/shell/page-frame';
import type { Controls } from '../../../src/page/shell/panels/controls';
import type { PassthroughHost } from '../../../src/page/shell/stage/passthrough-host';
import { fake } from './fake';

/**
 * A page that draws nothing, frame by frame as its device asks for them: a window, or a session, which lets windows
 * rest.
 */
function page(draw: () => void = () => undefined): PageFrame {
  const parts = fake<InputParts>({
    settings: { mirror: false },
    headset: { visibility: 'visible', worn: true, commands: null, turnIfAsked: () => false },
    activities: { name: 'studio', current: null, show: () => undefined },
    study: { run: null },
    stage: { look: () => undefined, draw },
    tracker: { avatar: null },
    gazeTargets: new GazeTargets(),
    mocap: { span: { from: 0, to: 0 } },
  });
  return new PageFrame(parts, fake<Controls>({ point: () => undefined }), fake<PassthroughHost>({}));
}

test('a wait for the next picture waits for the device that draws it, and no longer', async () => {
  const frame = page();
  frame.render(1, null);
  const seen: number[] = [];
  const waiting = frame.nextPicture().then(() => seen.push(frame.count));
  await Promise.resolve();
  expect(seen).toEqual([]);
  frame.render(2, null);
  frame.render(3, null);
  await waiting;
  expect(seen).toHaveLength(1);
});

test('a picture that fails is waited for no longer either', async () => {
  const frame = page(() => {
    throw new Error('no graphics device');
  });
  const waiting = frame.nextPicture();
  expect(() => frame.render(1, null)).toThrow('no graphics device');
  await waiting;
});

/** A page whose body an input source moves; returns what its avatar was set to. */
function moved({ calm = false, run = null as object | null, inputSource = 'actor' } = {}) {
  const set: { idle?: boolean; gaze?: Vec3 | null } = {};
  const avatar = {
    handGeometry: () => null,
    setMouth: () => undefined,
    setIdleMotion(on: boolean) {
      set.idle = on;
    },
    setGaze(target: Vec3 | null) {
      set.gaze = target && { ...target };
    },
  };
  const pose = { head: { position: vec3(0, 1.6, 0), orientation: identity } };
  const camera = { position: vec3(0.5, 1.5, -2) };
  const parts = fake<InputParts>({
    calm: { matches: calm },
    study: { run },
    settings: { mirror: false },
    gazeTargets: new GazeTargets(),
    tracker: { avatar, draw: () => undefined },
    activities: { inputSource, current: null, play: () => [], grasp: () => false, show: () => undefined },
    stage: { view: { camera }, look: () => undefined, draw: () => undefined },
    headset: { visibility: 'visible', worn: false, commands: null, turnIfAsked: () => false, buzz: () => undefined },
    source: { buttons: nothingPressed },
    recorder: { observe: () => undefined },
    degradation: { apply: (frame: TrackingFrame) => frame },
    difference: { observe: () => undefined },
    body: { calibration: defaultCalibration },
    mocap: { span: { from: 0, to: 0 }, frame: () => undefined },
  });
  const controls = fake<Controls>({ point: () => undefined, observe: () => undefined });
  const frame = new PageFrame(parts, controls, fake<PassthroughHost>({}));
  const tracked = { ...actorFrame(0, defaultCalibration), head: { ...pose.head, tracking: 'tracked' as const } };
  frame.observe(tracked);
  frame.skin(pose as AvatarPose);
  frame.render(1, tracked);
  return set;
}

test.each([
  ['an actor moves', {}, true],
  ['a person wears', { inputSource: 'headset' }, true],
  ['a recording moves', { inputSource: 'recording' }, false],
  ['a study shows', { run: { frame: () => undefined } }, false],
  ['a user with reduced motion sees', { calm: true }, false],
] as const)('the body that %s has the idle motion it should have', (_, page, idles) => {
  expect(moved(page).idle).toBe(idles);
});

test('the eyes of the user’s avatar meet the viewer’s at the desktop', () => {
  expect(moved().gaze).toEqual(vec3(0.5, 1.5, -2));
});
