import { Group, type Mesh, Vector3, type WebGLRenderer } from 'three';
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { defaultCalibration } from '../../src/core/body/calibration';
import { forwardKinematics } from '../../src/core/body/forward-kinematics';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import { createIk } from '../../src/core/estimation/estimators';
import { invertTransform, type Pose } from '../../src/core/math/pose';
import { fromAxisAngle, identity } from '../../src/core/math/quat';
import { distance, up, type Vec3 } from '../../src/core/math/vec3';
import { toXRBody } from '../../src/core/motion/xr-body';
import { actorFrame } from '../../src/core/tracking/actor-motion';
import type { TrackingFrame } from '../../src/core/tracking/tracking-frame';
import { avatarMotion, BodyTracker, type BodyTrackerOptions, loadAvatar } from '../../src/lib/three';
import { changed, mannequin } from '../avatar/glb';
import { poseOf } from '../core/estimation/drawn';
import { movingPerson } from '../core/estimation/moving-person';
import { openPlainModel } from '../core/estimation/shipped-models';
import { controller, fakeHeadset } from '../xr/fake-headset';

const left = { position: { x: -0.3, y: 1.2, z: -0.3 }, orientation: identity };
const right = { position: { x: 0.3, y: 1.2, z: -0.3 }, orientation: identity };

/** The part of a renderer that a tracker asks, with a headset that can be put on and taken off. */
function wornHeadset() {
  const headset = fakeHeadset();
  headset.setInputs(controller('left', left), controller('right', right));
  let worn = false;
  let space: XRReferenceSpace | null = null;
  const xr = {
    getSession: () => (worn ? headset.session : null),
    getReferenceSpace: () => space ?? headset.floor,
    setReferenceSpace(next: XRReferenceSpace | null) {
      space = next;
    },
  };
  return {
    ...headset,
    xr,
    renderer: { xr } as unknown as WebGLRenderer,
    putOn: () => {
      worn = true;
      space = null;
    },
    takeOff: () => {
      worn = false;
      headset.session.dispatchEvent(new Event('end'));
    },
    /** The page stands its wearer's floor here in the space that it draws in [m, rad]. */
    moveFloorTo({ x, y, z }: Vec3, yaw = 0) {
      const floor: Pose<'floor'> = { position: { x, y, z }, orientation: fromAxisAngle(up, yaw) };
      const { position, orientation } = invertTransform<'floor', 'floor'>(floor);
      const origin = new XRRigidTransform({ ...position, w: 1 }, orientation);
      xr.setReferenceSpace(headset.floor.getOffsetReferenceSpace(origin));
    },
    /** Where the renderer has the eyes. */
    eyes(): Vec3 {
      const { x, y, z } = headset.frame.getViewerPose(xr.getReferenceSpace())!.transform.position;
      return { x, y, z };
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
  /** Where a point of the floor frame is drawn. */
  const drawn = (point: Vec3): Vector3 => {
    tracker.object.updateMatrixWorld(true);
    return tracker.avatar.object.localToWorld(new Vector3().copy(point));
  };
  return { headset, tracker, told, run, drawn };
}

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
    expect(ownHeadSeen(tracker)).toBe(false);
    // At once: there are pages that draw within a session alone.
    headset.takeOff();
    expect(tracker.object.visible).toBe(false);
    expect(ownHeadSeen(tracker)).toBe(true);
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

  test('goes on after a frame of the page’s own with a time that is no number', async () => {
    const { tracker } = await begin({ calibration: defaultCalibration });
    const wearer = (time: number) => actorFrame(time, defaultCalibration);
    for (let i = 0; i < 72; i++) tracker.follow({ ...wearer(i / 72), ...(i === 20 && { time: Number.NaN }) });
    const turned: number[] = [];
    tracker.object.traverse(({ quaternion }) => turned.push(...quaternion));
    expect(turned.every(Number.isFinite)).toBe(true);
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

  test('lies where the page has teleported its wearer, and knows nothing of it: no way there, no jump, no other pose', async () => {
    const { headset, tracker, run, told, drawn } = await begin({ calibration: defaultCalibration });
    tracker.addEventListener('jumped', () => told.push('jumped'));
    headset.putOn();
    run(30);
    const before = structuredClone(tracker.avatar.jointPositions());
    told.length = 0;
    headset.moveFloorTo({ x: 5, y: 0, z: -2 }, 1);
    run(1);
    const { hips, leftHand } = tracker.avatar.jointPositions();
    expect(distance(hips!, before.hips!)).toBeLessThan(0.001);
    expect(distance(leftHand!, tracker.pose!.leftHand!.position)).toBeLessThan(0.001);
    expect(distance(drawn(tracker.pose!.head.position), headset.eyes())).toBeLessThan(1e-6);
    expect(drawn(hips!).x).toBeGreaterThan(4.5);
    expect(told).toEqual([]);
  });

  test('moves under a page that glides its wearer as it does under one that does not', async () => {
    const [glides, stands] = [
      await begin({ calibration: defaultCalibration }),
      await begin({ calibration: defaultCalibration }),
    ];
    const person = movingPerson(3, defaultCalibration, { x: 0, z: 0, yaw: 0 });
    let jumps = 0;
    for (const { headset } of [glides, stands]) headset.putOn();
    glides.run(1);
    stands.run(1);
    glides.tracker.addEventListener('jumped', () => {
      jumps += 1;
    });
    for (let frame = 1; frame < 150; frame++) {
      const { head, leftHand, rightHand } = person(frame / 72);
      for (const { headset, run } of [glides, stands]) {
        headset.setHead(head);
        headset.setInputs(controller('left', leftHand), controller('right', rightHand));
        if (headset === glides.headset) headset.moveFloorTo({ x: frame / 72, y: 0, z: 0 }, frame / 144);
        run(1);
      }
      const [a, b] = [glides.tracker.avatar.jointPositions(), stands.tracker.avatar.jointPositions()];
      expect(distance(a.leftLowerArm!, b.leftLowerArm!)).toBeLessThan(1e-9);
      expect(distance(glides.drawn(head.position), glides.headset.eyes())).toBeLessThan(1e-6);
    }
    expect(jumps).toBe(0);
  });

  test.each([0.1, 3, -3])(
    'stands on a floor that is %s m higher as on any other, and grows for none',
    async (height) => {
      const { headset, tracker, run, drawn } = await begin();
      headset.putOn();
      run(100);
      const { eyeHeight } = tracker.calibration;
      const before = structuredClone(tracker.avatar.jointPositions());
      headset.moveFloorTo({ x: 0, y: height, z: 0 });
      run(200);
      expect(tracker.calibration.eyeHeight).toBe(eyeHeight);
      const { hips, leftFoot } = tracker.avatar.jointPositions();
      expect(drawn(hips!).y - height).toBeCloseTo(before.hips!.y, 2);
      expect(drawn(leftFoot!).y - height).toBeCloseTo(before.leftFoot!.y, 2);
    },
  );

  test('that comes to a wearer whom the page has raised already is as tall as they are', async () => {
    const { headset, tracker, run, drawn } = await begin();
    headset.putOn();
    headset.moveFloorTo({ x: 1, y: 3, z: 0 });
    run(100);
    expect(tracker.calibration.eyeHeight).toBeCloseTo(1.6);
    expect(distance(drawn(tracker.pose!.head.position), headset.eyes())).toBeLessThan(1e-6);
  });

  test('recentres on the height to which the page has raised its wearer', async () => {
    const { headset, tracker, run, drawn } = await begin({ calibration: defaultCalibration });
    headset.setHead({ position: { x: 2, y: 1.6, z: 1 }, orientation: fromAxisAngle(up, 1) });
    headset.putOn();
    headset.moveFloorTo({ x: 5, y: 3, z: 0 }, 2);
    run(2);
    tracker.recentre();
    run(1);
    expect(distance(tracker.pose!.head.position, { x: 0, y: 1.6, z: 0 })).toBeLessThan(1e-6);
    expect(distance(headset.eyes(), { x: 0, y: 4.6, z: 0 })).toBeLessThan(1e-6);
    expect(distance(drawn(tracker.pose!.head.position), headset.eyes())).toBeLessThan(1e-6);
  });

  test('gives a page its own space back when the device recentres after the wearer did', async () => {
    const { headset, tracker, run, told } = await begin({ calibration: defaultCalibration });
    tracker.addEventListener('jumped', () => told.push('jumped'));
    headset.putOn();
    headset.moveFloorTo({ x: 5, y: 3, z: 0 });
    const own = headset.xr.getReferenceSpace();
    run(2);
    tracker.recentre();
    tracker.recentre();
    run(1);
    told.length = 0;
    headset.reset({ position: { x: 1, y: 0, z: 0 }, orientation: identity });
    expect(headset.xr.getReferenceSpace()).toBe(own);
    expect(told).toEqual(['jumped']);
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
    // It knows that of the session, wherever the page moves its wearer.
    headset.moveFloorTo({ x: 1, y: 0, z: 0 });
    run(1);
    expect(wrist()).toBeGreaterThan(0.1);
    run(100);
    expect(wrist()).toBeGreaterThan(0.1);
  });

  test('knows no space of the session before: it reads from the first frame on', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    const { floor } = headset;
    const old = floor.getOffsetReferenceSpace(new XRRigidTransform({ x: 3 }, identity));
    const { getReferenceSpace } = headset.xr;
    headset.xr.getReferenceSpace = () => old;
    tracker.update(1001, undefined);
    headset.xr.getReferenceSpace = getReferenceSpace;
    run(1);
    expect(tracker.pose!.head.position.x).toBe(0);
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
    tracker.follow(standing);
    expect(tracker.object.visible).toBe(true);
    expect(ownHeadSeen(tracker)).toBe(true);
  });

  test('of a page’s own frames hides its head from the wearer of a session, but shows them the head of a stand-in', async () => {
    const { headset, tracker } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    tracker.follow(standing);
    expect(ownHeadSeen(tracker)).toBe(false);
    tracker.follow({ ...standing, time: 1.1 }, defaultCalibration);
    expect(ownHeadSeen(tracker)).toBe(true);
    tracker.follow({ ...standing, time: 1.2 });
    headset.takeOff();
    expect(ownHeadSeen(tracker)).toBe(true);
  });

  test('that is disposed of stays so: no frame shows it again, and nothing is listened to', async () => {
    const { headset, tracker, run, told } = await begin({ calibration: defaultCalibration });
    const scene = new Group().add(tracker.object);
    headset.putOn();
    run(2);
    const space = headset.xr.getReferenceSpace();
    const pose = structuredClone(tracker.pose);
    told.length = 0;
    await tracker.dispose();
    headset.setHead({ position: { x: 1, y: 1.6, z: 0 }, orientation: identity });
    run(2);
    tracker.follow(standing);
    tracker.recentre();
    expect(scene.children).toEqual([]);
    expect(tracker.object.visible).toBe(false);
    expect(tracker.pose).toEqual(pose);
    expect(headset.xr.getReferenceSpace()).toBe(space);
    expect(told).toEqual([]);
    await tracker.dispose();
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

  test.each(Object.entries({ loadAvatar, avatarMotion }))(
    'that has not arrived whole is refused by %s',
    async (_, take) => {
      await expect(take(mannequin().slice(0, -4))).rejects.toThrow(/^the avatar: no VRM or GLB file \(.*cut short\)$/);
    },
  );
});
