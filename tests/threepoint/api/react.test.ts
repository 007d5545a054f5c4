import { VRMUtils } from '@pixiv/three-vrm';
import { act } from '@react-three/fiber';
import { createElement, createRef } from 'react';
import { actorFrame, defaultCalibration } from 'threepoint/core';
import { beforeEach, describe, expect, test, vi } from 'vitest';
import { RemoteAvatar, SelfAvatar } from '../../../src/threepoint/api/react';
import type { Avatar, BodyTracker } from '../../../src/threepoint/api/three';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { mannequin } from '../avatar/glb';
import { poseOf } from '../core/estimation/drawn';
import { openCanvas } from './canvas';

const tall = { eyeHeight: 1.8, armSpan: 1.7 };
const pose = poseOf(createIk(defaultCalibration), actorFrame(1, defaultCalibration));

/** Requests for avatars that wait for an answer: a test decides when each file arrives. */
let requests: ((answer: Response) => void)[];
const file = () => new Response(mannequin());
const missing = () => new Response(null, { status: 404, statusText: 'Not Found' });

let canvas: Awaited<ReturnType<typeof openCanvas>>;
let timeMs = 1000;

/** Answers the oldest request, and waits until what it loads is there. */
async function answer(response: Response, loaded: () => unknown): Promise<void> {
  requests.shift()!(response);
  await canvas.settle(loaded);
}

beforeEach(async () => {
  vi.stubGlobal('fetch', () => new Promise<Response>((resolve) => requests.push(resolve)));
  requests = [];
  vi.spyOn(performance, 'now').mockImplementation(() => (timeMs += 14));
  canvas = await openCanvas();
});

const bodies = () => canvas.children.filter(({ name }) => name === 'body');

describe('SelfAvatar', () => {
  const options = { avatar: '/me.vrm', estimator: 'ik', calibration: defaultCalibration } as const;

  test('mounted twice by StrictMode draws one body and disposes of the other', async () => {
    const disposed = vi.spyOn(VRMUtils, 'deepDispose');
    const ref = createRef<BodyTracker>();
    await canvas.show(createElement(SelfAvatar, { ...options, ref }), { strict: true });
    expect(requests).toHaveLength(2);
    await answer(file(), () => disposed.mock.calls.length === 1);
    expect(ref.current).toBeNull();
    await answer(file(), () => ref.current);
    expect(bodies()).toEqual([ref.current!.object]);
    canvas.headset.putOn();
    await canvas.draw(3);
    expect(ref.current!.object.visible).toBe(true);
    expect(disposed).toHaveBeenCalledTimes(1);
  });

  test('unmounted while it loads disposes of the avatar that arrives, without a word', async () => {
    const disposed = vi.spyOn(VRMUtils, 'deepDispose');
    await canvas.show(createElement(SelfAvatar, options));
    await canvas.show(null);
    await answer(file(), () => disposed.mock.calls.length === 1);
    expect(bodies()).toEqual([]);
    await canvas.show(createElement(SelfAvatar, options));
    await canvas.show(null);
    requests.shift()!(missing());
    await canvas.draw(1);
    expect(canvas.errors).toEqual([]);
  });

  test('throws to the nearest boundary what it cannot load, and options that a tracker refuses', async () => {
    await canvas.show(createElement(SelfAvatar, options));
    await answer(missing(), () => canvas.errors.length > 0);
    expect(canvas.errors).toEqual(['me.vrm: the server answers 404 Not Found']);
    await canvas.show(createElement(SelfAvatar, { ...options, calibration: { eyeHeight: 160, armSpan: 1.5 } }));
    await answer(file(), () => canvas.errors.length > 1);
    expect(canvas.errors[1]).toMatch(/160/);
  });

  test.each([
    ['an unknown estimator', { estimator: 'iks' as 'ik' }, /iks/],
    ['centimetres', { calibration: { eyeHeight: 160, armSpan: 150 } }, /160/],
  ])('throws %s that comes later to the nearest boundary', async (_, changed, sentence) => {
    const ref = createRef<BodyTracker>();
    await canvas.show(createElement(SelfAvatar, { ...options, ref }));
    await answer(file(), () => ref.current);
    await canvas.show(createElement(SelfAvatar, { ...options, ...changed, ref }));
    await vi.waitFor(() => expect(canvas.errors).toEqual([expect.stringMatching(sentence)]));
  });

  test('follows its estimator and measures, and is not changed by equal ones', async () => {
    const calibrated: number[] = [];
    const ref = createRef<BodyTracker>();
    const onCalibrated = ({ calibration }: { calibration: typeof tall }) => calibrated.push(calibration.eyeHeight);
    const update = (props: object) =>
      canvas.show(createElement(SelfAvatar, { ...options, ref, onCalibrated, ...props }));
    await update({});
    await answer(file(), () => ref.current);
    const first = ref.current;
    await update({ calibration: { ...defaultCalibration } });
    expect(calibrated).toEqual([]);
    await update({ calibration: tall, estimator: 'hands-only' });
    expect([calibrated, ref.current?.estimator]).toEqual([[tall.eyeHeight], 'hands-only']);
    expect(ref.current).toBe(first);
  });

  test('changed in avatar and measures at once draws the new avatar and leaves the old alone', async () => {
    const calibrated: number[] = [];
    const ref = createRef<BodyTracker>();
    const onCalibrated = ({ calibration }: { calibration: typeof tall }) => calibrated.push(calibration.eyeHeight);
    await canvas.show(createElement(SelfAvatar, { ...options, ref, onCalibrated }));
    await answer(file(), () => ref.current);
    const first = ref.current!;
    await canvas.show(
      createElement(SelfAvatar, { ...options, ref, onCalibrated, avatar: '/other.vrm', calibration: tall }),
    );
    expect([ref.current, bodies()]).toEqual([null, []]);
    await answer(file(), () => ref.current);
    expect(bodies()).toEqual([ref.current!.object]);
    expect(ref.current).not.toBe(first);
    expect(ref.current!.calibration.eyeHeight).toBe(tall.eyeHeight);
    expect([calibrated, first.calibration.eyeHeight]).toEqual([[], defaultCalibration.eyeHeight]);
  });

  test('calls the newest callbacks with poses and events', async () => {
    const ref = createRef<BodyTracker>();
    const calls: string[] = [];
    const update = (name: string) =>
      canvas.show(
        createElement(SelfAvatar, {
          ...options,
          ref,
          onPose: () => calls.push(`${name} pose`),
          onSessionStart: () => calls.push(`${name} start`),
          onSessionEnd: () => calls.push(`${name} end`),
        }),
      );
    await update('old');
    await answer(file(), () => ref.current);
    canvas.headset.putOn();
    await canvas.draw(1);
    await update('new');
    await canvas.draw(1);
    canvas.headset.takeOff();
    await canvas.draw(1);
    expect(calls).toEqual(['old start', 'old pose', 'new pose', 'new end']);
  });

  test.each([true, false])('reports a network that failed to onFallback (%s), else by a warning', async (handled) => {
    const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined);
    const reasons: string[] = [];
    const onFallback = ({ reason }: { reason: string }) => reasons.push(reason);
    let fail: (error: Error) => void = () => undefined;
    const networks = () => new Promise<never>((_, reject) => (fail = reject));
    const ref = createRef<BodyTracker>();
    const props = { ...options, estimator: 'learned', networks, ref } as const;
    // The callback comes or goes after the tracker was made.
    await canvas.show(createElement(SelfAvatar, handled ? props : { ...props, onFallback }));
    await answer(file(), () => ref.current);
    await canvas.show(createElement(SelfAvatar, handled ? { ...props, onFallback } : props));
    await act(async () => fail(new Error('learned.bin: gone')));
    expect(reasons).toEqual(handled ? ['learned.bin: gone'] : []);
    const warned = [[expect.stringMatching(/learned\.bin: gone\./)]];
    expect(warn.mock.calls).toEqual(handled ? [] : warned);
  });
});

describe('RemoteAvatar', () => {
  test('draws the pose, or that of a ref, and is hidden without one', async () => {
    const ref = createRef<Avatar>();
    const held: { current: typeof pose | null } = { current: null };
    await canvas.show(createElement(RemoteAvatar, { avatar: '/them.vrm', pose: held, ref }));
    await answer(file(), () => ref.current);
    const seen: boolean[] = [];
    const look = async (next: typeof held | typeof pose | null) => {
      await canvas.show(createElement(RemoteAvatar, { avatar: '/them.vrm', pose: next, ref }));
      await canvas.draw(1);
      seen.push(ref.current!.object.visible);
    };
    await look(held);
    held.current = pose;
    await look(held);
    await look(null);
    await look(pose);
    // A ref of JavaScript, which holds undefined at first.
    await look({ current: undefined } as unknown as typeof held);
    expect(seen).toEqual([false, true, false, true, false]);
  });

  test('has the measures of its prop, and those of an average adult without them', async () => {
    const ref = createRef<Avatar>();
    const heights: number[] = [];
    const look = async (calibration?: typeof tall) => {
      await canvas.show(
        createElement(RemoteAvatar, { avatar: '/them.vrm', pose, ref, ...(calibration && { calibration }) }),
      );
      heights.push(ref.current?.height ?? 0);
    };
    await canvas.show(createElement(RemoteAvatar, { avatar: '/them.vrm', pose, ref }));
    await answer(file(), () => ref.current);
    await look();
    await look(tall);
    await look({ ...tall });
    await look();
    const [average, larger, same, back] = heights;
    expect(larger).toBeGreaterThan(average! + 0.1);
    expect([same, back]).toEqual([larger, average]);
  });

  test('throws an avatar that cannot be loaded to the nearest boundary', async () => {
    await canvas.show(createElement(RemoteAvatar, { avatar: '/them.vrm', pose: null }));
    await answer(missing(), () => canvas.errors.length > 0);
    expect(canvas.errors).toEqual(['them.vrm: the server answers 404 Not Found']);
  });
});
