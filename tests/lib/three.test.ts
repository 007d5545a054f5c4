import type { WebGLRenderer } from 'three';
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { defaultCalibration } from '../../src/core/body/calibration';
import { forwardKinematics } from '../../src/core/body/forward-kinematics';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import { createIk } from '../../src/core/estimation/estimators';
import { fromAxisAngle, identity } from '../../src/core/math/quat';
import { distance, up } from '../../src/core/math/vec3';
import { toXRBody } from '../../src/core/motion/xr-body';
import { actorFrame } from '../../src/core/tracking/actor-motion';
import { BodyTracker, type BodyTrackerOptions, loadAvatar } from '../../src/lib/three';
import { changed, mannequin } from '../avatar/glb';
import { poseOf } from '../core/estimation/drawn';
import { openPlainModel } from '../core/estimation/shipped-models';
import { controller, fakeHeadset } from '../xr/fake-headset';

const left = { position: { x: -0.3, y: 1.2, z: -0.3 }, orientation: identity };
const right = { position: { x: 0.3, y: 1.2, z: -0.3 }, orientation: identity };

/** The part of a renderer that a tracker asks, with a headset that can be put on and taken off. */
function wornHeadset() {
  const headset = fakeHeadset();
  headset.setInputs(controller('left', left), controller('right', right));
  let worn = false;
  let space = headset.floor;
  const xr = {
    getSession: () => (worn ? headset.session : null),
    getReferenceSpace: () => (worn ? space : null),
    setReferenceSpace(next: XRReferenceSpace) {
      space = next;
    },
  };
  return {
    ...headset,
    xr,
    renderer: { xr } as unknown as WebGLRenderer,
    putOn: () => {
      worn = true;
    },
    takeOff: () => {
      worn = false;
    },
  };
}

async function begin(options: Partial<BodyTrackerOptions> = {}) {
  const headset = wornHeadset();
  const tracker = new BodyTracker(headset.renderer, {
    avatar: await loadAvatar(mannequin()),
    networks: async () => openPlainModel(),
    ...options,
  });
  const told: string[] = [];
  for (const type of ['lost', 'found'] as const) {
    tracker.addEventListener(type, ({ point }) => told.push(`${type} ${point}`));
  }
  tracker.addEventListener('calibrated', ({ source }) => told.push(`calibrated ${source}`));
  tracker.addEventListener('fallback', ({ reason }) => told.push(`fallback ${reason}`));
  let timeMs = 1000;
  const run = (frames: number) => {
    for (let frame = 0; frame < frames; frame++) {
      timeMs += 1000 / 72;
      tracker.update(timeMs, headset.frame);
    }
  };
  return { headset, tracker, told, run };
}

afterEach(() => {
  vi.unstubAllGlobals();
});

describe('a body in a session of three.js', () => {
  test('appears with the session, hands on the controllers, and goes with it', async () => {
    const { headset, tracker, run, told } = await begin({ calibration: defaultCalibration });
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
    headset.takeOff();
    run(1);
    expect(tracker.object.visible).toBe(false);
    expect(told).toEqual(['found head', 'found left', 'found right']);
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

  test('takes its height from the headset', async () => {
    const { headset, tracker, run, told } = await begin();
    headset.setHead({ position: { x: 0, y: 1.5, z: 0 }, orientation: identity });
    headset.putOn();
    run(72);
    expect(told).toContain('calibrated headset');
    expect(tracker.calibration.eyeHeight).toBeCloseTo(1.5);
  });

  test('recentres: the head stands at the origin and looks ahead, and the renderer draws in the same space', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    headset.setHead({ position: { x: 2, y: 1.6, z: 1 }, orientation: fromAxisAngle(up, 1) });
    headset.putOn();
    run(2);
    const before = headset.xr.getReferenceSpace();
    tracker.recentre();
    expect(headset.xr.getReferenceSpace()).not.toBe(before);
    run(1);
    const { position, orientation } = tracker.pose!.head;
    expect(distance(position, { x: 0, y: 1.6, z: 0 })).toBeLessThan(1e-6);
    expect(orientation.w).toBeCloseTo(1);
  });

  test('follows a teleport of the page without drawing the way', async () => {
    const { headset, tracker, run, told } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    run(30);
    const space = headset.xr.getReferenceSpace()!;
    const there = new XRRigidTransform({ x: -5, y: 0, z: 0, w: 1 }, { x: 0, y: 0, z: 0, w: 1 });
    headset.xr.setReferenceSpace(space.getOffsetReferenceSpace(there));
    run(1);
    const { hips, leftHand } = tracker.avatar.jointPositions();
    expect(hips!.x).toBeGreaterThan(4.5);
    expect(distance(leftHand!, tracker.pose!.leftHand!.position)).toBeLessThan(0.001);
    expect(told).toEqual(['found head', 'found left', 'found right']);
  });

  test('leaves the space of a page that has moved its wearer to the page, also when the device recentres', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    run(2);
    tracker.recentre();
    run(1);
    const there = new XRRigidTransform({ x: -5, y: 0, z: 0, w: 1 }, { x: 0, y: 0, z: 0, w: 1 });
    const moved = headset.floor.getOffsetReferenceSpace(there);
    headset.xr.setReferenceSpace(moved);
    run(1);
    headset.reset({ position: { x: 1, y: 0, z: 0 }, orientation: identity });
    expect(headset.xr.getReferenceSpace()).toBe(moved);
  });

  test('of a device that never calls anything tracked, as emulators do, has its hands on the controllers too', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    const guessed = { ...left, emulated: true };
    headset.setInputs(controller('left', guessed), controller('right', right));
    headset.putOn();
    run(40);
    const wrist = () => distance(tracker.avatar.jointPositions().leftHand!, tracker.pose!.leftHand!.position);
    expect(wrist()).toBeLessThan(0.001);
    // Once it has told, it is believed where it only guesses: the arm sinks to rest.
    headset.setInputs(controller('left', left), controller('right', right));
    run(2);
    headset.setInputs(controller('left', guessed), controller('right', right));
    run(400);
    expect(wrist()).toBeGreaterThan(0.1);
  });

  test('says which hand is lost and which is found', async () => {
    const { headset, run, told } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    run(2);
    headset.setInputs(controller('right', right));
    run(2);
    headset.setInputs(controller('left', left), controller('right', right));
    run(2);
    expect(told.slice(3)).toEqual(['lost left', 'found left']);
  });

  test('a frame of the page’s own moves it without a session', async () => {
    const { tracker } = await begin({ calibration: defaultCalibration });
    tracker.follow({
      time: 1,
      head: { position: { x: 0, y: 1.6, z: 0 }, orientation: identity, tracking: 'tracked' },
      leftHand: null,
      rightHand: null,
    });
    expect(tracker.object.visible).toBe(true);
    tracker.dispose();
    expect(tracker.object.parent).toBeNull();
  });
});

describe('an avatar', () => {
  beforeEach(() => {
    vi.stubGlobal('self', globalThis);
  });

  /** The mannequin as other programs write it: no VRM, its nodes called as nothing else is. */
  const bones: Record<string, string> = {};
  const foreign = changed((json) => {
    for (const [bone, { node }] of Object.entries(json.extensions.VRMC_vrm?.humanoid.humanBones ?? {})) {
      bones[bone] = `part ${node}`;
      json.nodes[node]!.name = `part ${node}`;
    }
    json.extensions = {};
    json.extensionsUsed = [];
  });

  test('of a humanoid without VRM stands on a map of its bones', async () => {
    const [own, other] = [await loadAvatar(mannequin()), await loadAvatar(foreign, { bones })];
    const pose = poseOf(createIk(defaultCalibration), actorFrame(1, defaultCalibration));
    const wrist = (avatar: typeof own) => {
      avatar.fitTo(defaultCalibration);
      avatar.apply(pose, 1);
      return avatar.jointPositions().leftHand!;
    };
    expect(distance(wrist(own), pose.leftHand!.position)).toBeLessThan(0.001);
    expect(distance(wrist(other), wrist(own))).toBeLessThan(1e-6);
  });

  test('without a map it is refused, and a map with a name that is not there too', async () => {
    await expect(loadAvatar(foreign)).rejects.toThrow(/no humanoid in it/);
    await expect(loadAvatar(foreign, { bones: { ...bones, leftHand: 'Paw' } })).rejects.toThrow(
      'the avatar: bones.leftHand: no node is called “Paw”',
    );
    const { leftHand, ...handless } = bones;
    expect(leftHand).toBeDefined();
    await expect(loadAvatar(foreign, { bones: handless })).rejects.toThrow('its humanoid has no leftHand');
  });
});
