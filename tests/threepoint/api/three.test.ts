import { Group, type Mesh, type WebGLRenderer } from 'three';
import { describe, expect, test, vi } from 'vitest';
import { type Avatar, BodyTracker, type BodyTrackerOptions, loadAvatar } from '../../../src/threepoint/api/three';
import { pinning, trackerAtJoint } from '../../../src/threepoint/api/trackers';
import { defaultCalibration } from '../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../src/threepoint/core/body/forward-kinematics';
import { skeletonFromCalibration } from '../../../src/threepoint/core/body/skeleton';
import { identity } from '../../../src/threepoint/core/math/quat';
import { distance, type Vec3 } from '../../../src/threepoint/core/math/vec3';
import { toXRBody } from '../../../src/threepoint/core/motion/xr-body';
import { actorFrame } from '../../../src/threepoint/core/tracking/actor-motion';
import type { BodyTrackers, TrackingFrame } from '../../../src/threepoint/core/tracking/tracking-frame';
import { gripDevice } from '../../../src/threepoint/xr/grip-offsets';
import { mannequin } from '../avatar/glb';
import { controller } from '../xr/fake-headset';
import { begin, left, right, wornHeadset } from './three-session';

/** Whether the head is drawn for the eyes that are in it. */
function ownHeadSeen(tracker: BodyTracker): boolean {
  let seen = false;
  tracker.object.traverse((node) => {
    if (/head/i.test(node.name) && (node as Mesh).isMesh) seen ||= node.layers.isEnabled(0);
  });
  return seen;
}

const standing: TrackingFrame = {
  time: 1,
  head: { position: { x: 0, y: 1.6, z: 0 }, orientation: identity, tracking: 'tracked' },
  leftHand: null,
  rightHand: null,
};

describe('a body in a session of three.js', () => {
  test('appears with the session, hands on the controllers, and goes with it', async () => {
    const { headset, tracker, run, reported } = await begin({ calibration: defaultCalibration });
    run(3);
    expect(tracker.pose).toBeNull();
    expect(tracker.object.visible).toBe(false);
    headset.putOn();
    run(40);
    expect(tracker.object.visible).toBe(true);
    expect(tracker.estimator).toBe('learned');
    const { leftHand, rightHand } = tracker.avatar.jointPositions();
    expect(distance(leftHand!, tracker.pose!.leftHand!.position)).toBeLessThan(0.001);
    expect(distance(rightHand!, tracker.pose!.rightHand!.position)).toBeLessThan(0.001);
    // The wrist lies a hand's length behind the grip.
    expect(distance(leftHand!, left.position)).toBeLessThan(0.12);
    expect(ownHeadSeen(tracker)).toBe(false);
    // At once: there are pages that draw within a session alone.
    headset.takeOff();
    expect(tracker.object.visible).toBe(false);
    expect(ownHeadSeen(tracker)).toBe(true);
    run(1);
    expect(tracker.object.visible).toBe(false);
    expect(reported).toEqual(['session start', 'found head', 'found left', 'found right', 'session end']);
  });

  test('stands on the trackers that the page supplies, and on its gait again without them', async () => {
    let trackers: BodyTrackers | null = null;
    const calibration = { ...defaultCalibration, trackerOffsets: { hips: trackerAtJoint, leftFoot: trackerAtJoint } };
    const { headset, tracker, run } = await begin({ calibration, pinning, trackers: () => trackers });
    headset.putOn();
    run(40);
    const { hips, leftFoot } = tracker.avatar.jointPositions();
    const held = (joint: Vec3 | undefined) => ({
      orientation: identity,
      position: { ...joint!, x: joint!.x + 0.03 },
      tracking: 'tracked' as const,
    });
    const free = { hips: held(hips), leftFoot: held(leftFoot) };
    trackers = free;
    run(40);
    expect(distance(tracker.pose!.body!.hipsPosition, free.hips.position)).toBeLessThan(0.001);
    expect(distance(tracker.avatar.jointPositions().leftFoot!, free.leftFoot.position)).toBeLessThan(0.001);
    trackers = null;
    run(40);
    expect(distance(tracker.pose!.body!.hipsPosition, free.hips.position)).toBeGreaterThan(0.02);
    expect(tracker.pose!.feet).toBeUndefined();
  });

  test('reports a tracker that the body does not reach for a second, with a sentence', async () => {
    const calibration = { ...defaultCalibration, trackerOffsets: { hips: trackerAtJoint } };
    const hips = { position: { x: 0, y: 0.4, z: 0 }, orientation: identity, tracking: 'tracked' as const };
    const { headset, tracker, run } = await begin({ calibration, pinning, trackers: () => ({ hips }) });
    const messages: string[] = [];
    tracker.addEventListener('trackermismatch', ({ message }) => messages.push(message));
    headset.putOn();
    run(40);
    expect(messages).toEqual([]);
    run(120);
    expect(messages).toEqual([
      expect.stringMatching(/^The hips tracker is \d+ cm further from the head than this body/),
    ]);
  });

  test('reports a tracker once that the calibration does not place', async () => {
    const hips = { position: { x: 0, y: 0.9, z: 0 }, orientation: identity, tracking: 'tracked' as const };
    const { headset, tracker, run } = await begin({
      ...{ calibration: defaultCalibration, pinning },
      trackers: () => ({ hips }),
    });
    const messages: string[] = [];
    tracker.addEventListener('trackermismatch', ({ message }) => messages.push(message));
    headset.putOn();
    run(40);
    expect(messages).toEqual(['The hips tracker is not used: the calibration has no trackerOffsets.hips.']);
  });

  test('refuses trackers without the part that draws them, and offsets that no tracker is worn with', async () => {
    const trackers = () => null;
    await expect(begin({ trackers })).rejects.toThrow(/pinning.*threepoint\/trackers/);
    const trackerOffsets = { hips: { ...trackerAtJoint, position: { x: 0, y: 0.5, z: 0 } } };
    const calibration = { ...defaultCalibration, trackerOffsets };
    await expect(begin({ trackers, pinning, calibration })).rejects.toThrow(/tracker “hips” is not a pose/);
    const { tracker } = await begin({ trackers, pinning });
    expect(() => tracker.calibrate(calibration)).toThrow(/tracker “hips” is not a pose/);
    expect(tracker.calibration.trackerOffsets).toBeUndefined();
  });

  test('has no pose after its session, so that a sending page leaves no frozen body', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    const atEnd: unknown[] = [];
    tracker.addEventListener('sessionend', () => atEnd.push(tracker.pose));
    headset.putOn();
    run(3);
    expect(tracker.pose).not.toBeNull();
    headset.takeOff();
    expect(tracker.pose).toBeNull();
    run(3);
    expect(tracker.pose).toBeNull();
    expect(atEnd).toEqual([null]);
    // The next session has a pose once it sees a head.
    headset.putOn();
    headset.setHead(null);
    run(3);
    expect(tracker.pose).toBeNull();
    headset.setHead({ position: { x: 0, y: 1.6, z: 0 }, orientation: identity });
    run(1);
    expect(tracker.pose).not.toBeNull();
  });

  test('warns of a network that failed once its last listener is removed', async () => {
    const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined);
    const networks = async () => Promise.reject(new Error('learned.bin: gone'));
    const avatar = await loadAvatar(mannequin());
    const tracker = new BodyTracker({ xr: {} } as WebGLRenderer, { avatar, networks });
    const listener = () => expect.unreachable('the listener was removed');
    tracker.addEventListener('fallback', listener);
    tracker.removeEventListener('fallback', listener);
    await vi.waitFor(() => expect(warn.mock.calls).toEqual([[expect.stringMatching(/learned\.bin: gone/)]]));
  });

  test('reports no end of a session whose frames it never read', async () => {
    const { headset, tracker, reported } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    tracker.updateFromFrame(standing);
    headset.takeOff();
    expect(reported.filter((line) => line.startsWith('session'))).toEqual([]);
  });

  test.each([true, false])('draws the body that the device tracks where it is asked to (%s)', async (deviceBody) => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration, estimator: 'device', deviceBody });
    headset.putOn();
    // What is drawn has settled: the correction within a tenth of a second, what is noticed of the hands within ten.
    run(720);
    const body = structuredClone(tracker.pose!.body);
    const joints = toXRBody(body!, defaultCalibration);
    // A device that sees the wearer's elbows 4 cm further out than they would be guessed.
    const seen = new Map(
      [...joints].map(([name, { position, orientation }]) => {
        const aside = name.endsWith('arm-lower') ? 0.04 * Math.sign(position.x) : 0;
        return [name, { at: { position: { ...position, x: position.x + aside }, orientation } }];
      }),
    );
    (headset.frame as unknown as Record<string, unknown>).body = seen;
    run(60);
    const skeleton = skeletonFromCalibration(defaultCalibration);
    const elbow = (pose: typeof body) => forwardKinematics(skeleton, pose!).leftLowerArm.position;
    const moved = distance({ ...elbow(tracker.pose!.body) }, { ...elbow(body) });
    if (deviceBody) expect(moved).toBeGreaterThan(0.01);
    else expect(moved).toBeLessThan(0.001);
  });

  test('goes on after a frame of the page’s own with a time that is no number', async () => {
    const { tracker } = await begin({ calibration: defaultCalibration });
    const wearer = (time: number) => actorFrame(time, defaultCalibration);
    for (let i = 0; i < 72; i++) tracker.updateFromFrame({ ...wearer(i / 72), ...(i === 20 && { time: Number.NaN }) });
    const turned: number[] = [];
    tracker.object.traverse(({ quaternion }) => turned.push(...quaternion));
    expect(turned.every(Number.isFinite)).toBe(true);
  });

  test('has its hands on the controllers of a device that tracks nothing, as emulators do', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    const guessed = { ...left, emulated: true };
    headset.setInputs(controller('left', guessed), controller('right', right));
    headset.putOn();
    run(40);
    const wrist = () => distance(tracker.avatar.jointPositions().leftHand!, tracker.pose!.leftHand!.position);
    expect(wrist()).toBeLessThan(0.001);
    // After it was reported as tracked, a guessed position counts as lost: the arm sinks to rest.
    headset.setInputs(controller('left', left), controller('right', right));
    run(2);
    headset.setInputs(controller('left', guessed), controller('right', right));
    run(400);
    expect(wrist()).toBeGreaterThan(0.1);
    // It knows that of the session, wherever the page moves its wearer.
    headset.moveFloorTo({ x: 1, y: 0, z: 0 });
    run(1);
    expect(wrist()).toBeGreaterThan(0.1);
    run(100);
    expect(wrist()).toBeGreaterThan(0.1);
  });

  test('draws the wrist where the user’s offset for the controller puts it', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration, estimator: 'ik' });
    headset.putOn();
    run(40);
    const before = { ...tracker.avatar.jointPositions().leftHand! };
    const [source] = headset.session.inputSources;
    tracker.body.setGripOffsets({ [gripDevice(source!.profiles)]: { left: { ahead: 0.03 } } });
    run(2);
    expect(distance(tracker.avatar.jointPositions().leftHand!, before)).toBeCloseTo(0.03, 3);
  });

  test('draws the hands that a game returns from its function of a frame', async () => {
    const { headset, tracker } = await begin({ calibration: defaultCalibration, estimator: 'ik' });
    headset.putOn();
    const raised = { ...standing.head, position: { x: 0.2, y: 1.7, z: 0 } };
    for (let frame = 0; frame < 40; frame++) {
      tracker.update(1000 + (frame * 1000) / 72, headset.frame, (tracked) => {
        expect(tracker.tracking!.inputs.buttons.left.trigger).toBe(0);
        return { ...tracked, rightHand: raised };
      });
    }
    const { leftHand, rightHand } = tracker.avatar.jointPositions();
    expect(distance(rightHand!, raised.position)).toBeLessThan(0.001);
    expect(distance(leftHand!, left.position)).toBeLessThan(0.12);
    expect(tracker.object.visible).toBe(true);
  });

  test('continues with another avatar from the next frame on, and disposes of the first', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    run(40);
    const [first, second] = [tracker.avatar, await loadAvatar(mannequin())];
    tracker.setAvatar(second);
    run(1);
    expect(tracker.object.children).toEqual([second.object]);
    expect(distance(second.jointPositions().leftHand!, tracker.pose!.leftHand!.position)).toBeLessThan(0.001);
    expect(ownHeadSeen(tracker)).toBe(false);
    expect(() => tracker.setAvatar(first)).toThrow('This avatar was disposed of with its BodyTracker.');
  });

  test('returns its avatars to a page that keeps them, and continues the session with each', async () => {
    const { headset, tracker, run, reported } = await begin({ calibration: defaultCalibration, disposeAvatar: false });
    headset.putOn();
    run(40);
    const [first, second] = [tracker.avatar, await loadAvatar(mannequin())];
    const dispose = vi.spyOn(first, 'dispose');
    const before = reported.length;
    tracker.setAvatar(second);
    run(1);
    expect(first.object.parent).toBeNull();
    tracker.setAvatar(first);
    run(1);
    expect(tracker.object.children).toEqual([first.object]);
    expect(distance(first.jointPositions().leftHand!, tracker.pose!.leftHand!.position)).toBeLessThan(0.001);
    expect(reported.slice(before)).toEqual([]);
    await tracker.dispose();
    expect(dispose).not.toHaveBeenCalled();
    expect(first.object.parent).toBeNull();
  });

  test('starts without an avatar, which follows', async () => {
    const { renderer } = wornHeadset();
    const tracker = new BodyTracker<Avatar | null>(renderer, { avatar: null, estimator: 'ik' });
    expect(tracker.avatar).toBeNull();
    tracker.updateFromFrame(standing);
    expect(tracker.pose).not.toBeNull();
    expect(tracker.object.visible).toBe(false);
    tracker.setAvatar(await loadAvatar(mannequin()));
    tracker.updateFromFrame({ ...standing, time: 1.1 });
    expect(tracker.object.visible).toBe(true);
    await tracker.dispose();
    const late = await loadAvatar(mannequin());
    tracker.setAvatar(late);
    expect(tracker.avatar).not.toBe(late);
  });

  test('a frame of the page’s own moves it without a session', async () => {
    const { tracker } = await begin({ calibration: defaultCalibration });
    tracker.updateFromFrame(standing);
    expect(tracker.object.visible).toBe(true);
    expect(ownHeadSeen(tracker)).toBe(true);
  });

  test('hides its head from the wearer in a page’s own frames, but shows a stand-in’s', async () => {
    const { headset, tracker } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    tracker.updateFromFrame(standing);
    expect(ownHeadSeen(tracker)).toBe(false);
    tracker.updateFromFrame({ ...standing, time: 1.1 }, defaultCalibration);
    expect(ownHeadSeen(tracker)).toBe(true);
    tracker.updateFromFrame({ ...standing, time: 1.2 });
    headset.takeOff();
    expect(ownHeadSeen(tracker)).toBe(true);
  });

  test('stays disposed of: no frame shows it again, and no event is listened to', async () => {
    const { headset, tracker, run, reported } = await begin({ calibration: defaultCalibration });
    const scene = new Group().add(tracker.object);
    headset.putOn();
    run(2);
    const space = headset.xr.getReferenceSpace();
    await tracker.dispose();
    expect(reported.at(-1)).toBe('session end');
    reported.length = 0;
    headset.setHead({ position: { x: 1, y: 1.6, z: 0 }, orientation: identity });
    const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined);
    run(2);
    tracker.updateFromFrame(standing);
    expect(warn.mock.calls).toEqual([[expect.stringContaining('“update” has no effect after “dispose”')]]);
    warn.mockRestore();
    tracker.recentre();
    expect(scene.children).toEqual([]);
    expect(tracker.object.visible).toBe(false);
    expect(tracker.pose).toBeNull();
    expect(headset.xr.getReferenceSpace()).toBe(space);
    expect(reported).toEqual([]);
    await tracker.dispose();
  });
});

describe('a tracker that is given the wrong things', () => {
  const create = (options: object) => () =>
    // reason: what a page without types may pass
    new BodyTracker({ xr: {} } as WebGLRenderer, options as BodyTrackerOptions);

  test('refuses an avatar that another tracker has or disposed of, which keeps its body', async () => {
    const { tracker, headset, run } = await begin({ calibration: defaultCalibration });
    const { avatar } = tracker;
    expect(create({ avatar })).toThrow(
      'This avatar belongs to another BodyTracker. Load one for each tracker: await loadAvatar(source).',
    );
    headset.putOn();
    run(2);
    expect(tracker.object.children).toEqual([avatar.object]);
    await tracker.dispose();
    expect(create({ avatar })).toThrow('This avatar was disposed of with its BodyTracker. Load it again:');
  });

  test('leaves the avatar free where its own options are refused', async () => {
    const avatar = await loadAvatar(mannequin());
    expect(create({ avatar, calibration: { eyeHeight: 160, armSpan: 150 } })).toThrow(RangeError);
    await new BodyTracker({ xr: {} } as WebGLRenderer, { avatar, estimator: 'ik' }).dispose();
  });

  test.each([
    ['an address', () => '/avatars/me.vrm', /^avatar is an address\. Load it first: avatar: await loadAvatar\(/],
    ['a URL', () => new URL('https://example.org/me.vrm'), /^avatar is an address/],
    ['a promise', () => loadAvatar(mannequin()), /^avatar is a promise\. Await it: avatar: await loadAvatar\(/],
    ['nothing', () => undefined, /^avatar is missing\. Load one: avatar: await loadAvatar\(/],
    ['an object of three.js', () => new Group(), /^avatar is not from loadAvatar\. Load one: /],
  ])('refuses %s for an avatar', (_, avatar, sentence) => {
    expect(create({ avatar: avatar() })).toThrow(sentence);
  });

  test('refuses an option that it does not know', async () => {
    const avatar = await loadAvatar(mannequin());
    expect(create({ avatar, deviceBoddy: true })).toThrow(
      /^“deviceBoddy” is not an option of BodyTracker\. Use avatar, /,
    );
    // reason: what a page without types may pass
    await expect(loadAvatar(mannequin(), { bone: {} } as object)).rejects.toThrow(
      '“bone” is not an option of loadAvatar',
    );
  });

  test.each([
    [
      'no options',
      () => new BodyTracker({ xr: {} } as WebGLRenderer, undefined as never),
      /^BodyTracker needs .* Use avatar, /,
    ],
    ['no renderer', () => new BodyTracker(undefined as never, {} as never), /^renderer is missing\. Pass the one/],
    [
      'options in the place of the renderer',
      () => new BodyTracker({} as never, undefined as never),
      /^renderer is no renderer of three\.js: it has no “xr”\. Pass the one/,
    ],
  ])('refuses %s', (_, call, sentence) => {
    expect(call).toThrow(sentence);
  });

  test('loads nothing without a source', async () => {
    await expect(loadAvatar(undefined as never)).rejects.toThrow(/^The avatar's source is missing\. Pass its address/);
    await expect(loadAvatar(5 as never)).rejects.toThrow(/^The avatar's source is neither an address nor a file/);
    const page = new TextEncoder().encode('\n<!doctype html><title>Not found</title>');
    await expect(loadAvatar(page)).rejects.toThrow(
      'the avatar: not a VRM or GLB file (a web page: is the address right?)',
    );
  });
});
