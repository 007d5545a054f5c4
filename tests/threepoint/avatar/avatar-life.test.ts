import { readFileSync } from 'node:fs';
import { Group, type Mesh, type Object3D, Quaternion, Vector3 } from 'three';
import { type Calibration, defaultCalibration } from 'threepoint/core';
import { fromAxisAngle, identity, up, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { type Avatar, createAvatar } from '../../../src/threepoint/avatar/avatar';
import { type LoadedAvatar, parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { shippedGait } from '../../../src/threepoint/core/estimation/gait/shipped-gait';
import { poseOf } from '../core/estimation/drawn';
import { changed } from './glb';

/** The mannequin with two strands of hair on springs, eyes on bones, and lids. */
const living = (surprised: Record<string, unknown> = {}): ArrayBuffer =>
  changed((json) => {
    const vrm = json.extensions.VRMC_vrm as unknown as Record<string, Record<string, unknown>>;
    const bones = vrm.humanoid?.humanBones as Record<string, { node: number }>;
    const head = json.nodes[bones.head!.node]!;
    const put = (name: string, translation: number[], children: number[] = []) =>
      json.nodes.push({ name, translation, ...(children.length > 0 && { children }) }) - 1;
    const tip = put('strand tip', [0, -0.1, -0.03]);
    const middle = put('strand middle', [0, 0, -0.12], [tip]);
    const root = put('strand root', [0, 0.1, -0.1], [middle]);
    const [left, right] = [put('left eye', [0.03, 0.06, 0.08]), put('right eye', [-0.03, 0.06, 0.08])];
    head.children = [...(head.children ?? []), root, left, right];
    bones.leftEye = { node: left };
    bones.rightEye = { node: right };
    const range = { inputMaxValue: 90, outputScale: 90 };
    vrm.lookAt = {
      ...{ type: 'bone', offsetFromHeadBone: [0, 0.06, 0], rangeMapHorizontalInner: range },
      ...{ rangeMapHorizontalOuter: range, rangeMapVerticalDown: range, rangeMapVerticalUp: range },
    };
    vrm.expressions = { preset: { blink: { isBinary: false }, aa: { isBinary: false }, surprised } };
    const joint = (node: number) => ({ node, hitRadius: 0.02, stiffness: 1, gravityPower: 0.6, dragForce: 0.4 });
    json.extensions.VRMC_springBone = {
      specVersion: '1.0',
      springs: [{ joints: [joint(root), joint(middle), joint(tip)] }],
    };
    json.extensionsUsed = [...json.extensionsUsed, 'VRMC_springBone'];
  });

async function opened(
  body: Calibration = defaultCalibration,
  file = living(),
): Promise<{ loaded: LoadedAvatar; avatar: Avatar }> {
  const loaded = await parseAvatar(file, 'living.vrm');
  const avatar = createAvatar(loaded);
  avatar.setCalibration(body);
  return { loaded, avatar };
}

/** Stands for so long with the head this far aside [m] and turned by so much [rad]. */
function stand(
  avatar: Avatar,
  from: number,
  seconds: number,
  place = { aside: 0, yaw: 0 },
  { body = defaultCalibration, rateHz = 72 } = {},
) {
  const ik = createIk(body);
  let time = from;
  for (; time < from + seconds; time += 1 / rateHz) {
    const head = {
      position: { x: place.aside, y: body.eyeHeight, z: 0 },
      orientation: place.yaw === 0 ? identity : fromAxisAngle(up, place.yaw),
      tracking: 'tracked' as const,
    };
    avatar.setPose(poseOf(ik, { time, head, leftHand: null, rightHand: null }), time);
  }
  return time;
}

const strandOf = (avatar: Avatar): Quaternion => {
  const root = avatar.object.getObjectByName('strand_root') as Object3D;
  return root.quaternion.clone();
};

describe('hair', () => {
  test('hangs alike on a child and on a giant, and swings back as fast', async () => {
    const [child, giant] = [
      { eyeHeight: 1.05, armSpan: 0.95 },
      { eyeHeight: 2.05, armSpan: 2.0 },
    ];
    const [small, large] = [await opened(child), await opened(giant)];
    stand(small.avatar, 0, 3, undefined, { body: child });
    stand(large.avatar, 0, 3, undefined, { body: giant });
    const [a, b] = [strandOf(small.avatar), strandOf(large.avatar)];
    expect(a.angleTo(new Quaternion())).toBeGreaterThan(0.1);
    expect(a.angleTo(b)).toBeLessThan(0.02);
    for (const time of [3, 3.1, 3.2]) {
      const seconds = 0.1;
      stand(small.avatar, time, seconds, { aside: 0, yaw: 0.6 }, { body: child });
      stand(large.avatar, time, seconds, { aside: 0, yaw: 0.6 }, { body: giant });
      expect(strandOf(small.avatar).angleTo(strandOf(large.avatar))).toBeLessThan(0.03);
    }
  });

  test('falls as fast in 20 frames a second as in 144', async () => {
    const fallen = async (rateHz: number): Promise<number> => {
      const { avatar } = await opened();
      stand(avatar, 0, 0.155, undefined, { rateHz });
      return strandOf(avatar).angleTo(new Quaternion());
    };
    const [slow, usual, fast] = [await fallen(20), await fallen(72), await fallen(144)];
    expect(slow / fast).toBeCloseTo(1, 3);
    expect(usual / fast).toBeCloseTo(1, 3);
  });

  test('swings when its wearer steps aside, but not when the floor moves under the wearer', async () => {
    const { avatar } = await opened();
    let time = stand(avatar, 0, 3);
    const still = strandOf(avatar);
    time = stand(avatar, time, 0.1, { aside: 0.2, yaw: 0 });
    expect(strandOf(avatar).angleTo(still)).toBeGreaterThan(0.02);
    time = stand(avatar, time, 3, { aside: 0.2, yaw: 0 });
    stand(avatar, time, 1 / 72, { aside: 5, yaw: 0 });
    const carried = avatar.object.getObjectByName('strand_root') as Object3D;
    avatar.object.updateMatrixWorld(true);
    const tip = avatar.object.getObjectByName('strand_tip') as Object3D;
    const apart = tip.getWorldPosition(new Vector3()).distanceTo(carried.getWorldPosition(new Vector3()));
    expect(apart).toBeLessThan(0.4);
    // At rest at once: nothing of five metres is in it.
    expect(strandOf(avatar).angleTo(new Quaternion())).toBeLessThan(1e-6);
  });

  test.each([
    ['itself', (avatar: Avatar) => avatar.object],
    ['with a group that it is in', (avatar: Avatar) => new Group().add(avatar.object)],
  ])('is at rest at once when the body teleports %s, head and hands unchanged', async (_, carrier) => {
    const { avatar } = await opened();
    const carried = carrier(avatar);
    const time = stand(avatar, 0, 3);
    expect(strandOf(avatar).angleTo(new Quaternion())).toBeGreaterThan(0.1);
    carried.position.set(5, -3, 0);
    stand(avatar, time, 1 / 72);
    expect(strandOf(avatar).angleTo(new Quaternion())).toBeLessThan(1e-6);
  });
});

/** How far an eye is turned to the left of the head [degrees]. */
function eyeYaw({ loaded }: { loaded: LoadedAvatar }): number {
  return loaded.vrm.lookAt?.yaw ?? Number.NaN;
}

describe('eyes', () => {
  test('stay on their target while the head turns a little, and leap ahead when it continues', async () => {
    const body = await opened();
    let time = stand(body.avatar, 0, 1);
    expect(eyeYaw(body)).toBeCloseTo(0, 3);
    // To the left by 8 degrees: the eyes are still to the right of it.
    time = stand(body.avatar, time, 0.1, { aside: 0, yaw: (8 * Math.PI) / 180 });
    expect(eyeYaw(body)).toBeCloseTo(-8, 1);
    stand(body.avatar, time, 0.1, { aside: 0, yaw: (20 * Math.PI) / 180 });
    expect(eyeYaw(body)).toBeCloseTo(0, 3);
  });

  test('turn to a target that is set, until it is too far aside or removed', async () => {
    const body = await opened();
    const { eyeHeight } = defaultCalibration;
    // 45 cm to the left of the face, a metre ahead: 24 degrees.
    body.avatar.setGaze(vec3(-0.45, eyeHeight, -1));
    let time = stand(body.avatar, 0, 1);
    expect(eyeYaw(body)).toBeCloseTo(24.2, 1);
    // The head turns to it by 20 degrees, and eyes stay on it.
    time = stand(body.avatar, time, 1, { aside: 0, yaw: (20 * Math.PI) / 180 });
    expect(eyeYaw(body)).toBeCloseTo(4.2, 1);
    time = stand(body.avatar, time, 1, { aside: 0, yaw: (-20 * Math.PI) / 180 });
    expect(eyeYaw(body)).toBeCloseTo(0, 3);
    time = stand(body.avatar, time, 1);
    expect(eyeYaw(body)).toBeCloseTo(24.2, 1);
    body.avatar.setGaze(null);
    stand(body.avatar, time, 1);
    expect(Math.abs(eyeYaw(body))).toBeLessThan(11);
  });

  test('moved by shapes of a file hold their target and leap as eyes on bones do', async () => {
    const range = { inputMaxValue: 90, outputScale: 1 };
    const bytes = changed(
      (json) => {
        const vrm = json.extensions.VRMC_vrm as unknown as Record<string, unknown>;
        const node = json.nodes.findIndex(({ name }) => name === 'faceSkin');
        const bind = (index: number) => ({ morphTargetBinds: [{ node, index, weight: 1 }] });
        vrm.expressions = { preset: { lookLeft: bind(0), lookRight: bind(1) } };
        vrm.lookAt = {
          ...{ type: 'expression', offsetFromHeadBone: [0, 0.06, 0], rangeMapHorizontalInner: range },
          ...{ rangeMapHorizontalOuter: range, rangeMapVerticalDown: range, rangeMapVerticalUp: range },
        };
      },
      readFileSync(new URL('../../../public/avatars/woman.vrm', import.meta.url)),
    );
    const { vrm } = await parseAvatar(bytes, 'painted-eyes.vrm');
    const avatar = createAvatar({
      name: 'painted-eyes.vrm',
      vrm,
      notes: [],
      gait: shippedGait,
      nodeIndices: new Map(),
    });
    avatar.setCalibration(defaultCalibration);
    const lookRight = () => {
      const shapes: number[] = [];
      avatar.object.traverse((node) => {
        const { morphTargetInfluences } = node as Mesh;
        if (morphTargetInfluences) shapes.push(morphTargetInfluences[1]!);
      });
      return Math.max(...shapes);
    };
    const degree = Math.PI / 180;
    let time = stand(avatar, 0, 0.1);
    time = stand(avatar, time, 0.1, { aside: 0, yaw: 8 * degree });
    expect(lookRight()).toBeCloseTo(8 / 90, 3);
    stand(avatar, time, 0.1, { aside: 0, yaw: 20 * degree });
    expect(lookRight()).toBeCloseTo(0, 3);
  });

  test('blink now and then, and are open most of the time', async () => {
    const { loaded, avatar } = await opened();
    let blinks = 0;
    let shut = 0;
    let before = 0;
    let time = 0;
    for (let i = 0; i < 60 * 30; i++) {
      time = stand(avatar, time, 1 / 72);
      const closed = loaded.vrm.expressionManager?.getValue('blink') ?? 0;
      if (closed > 0.5 && before <= 0.5) blinks += 1;
      if (closed > 0.5) shut += 1;
      before = closed;
    }
    const seconds = (60 * 30) / 72;
    expect(blinks).toBeGreaterThanOrEqual(seconds / 7);
    expect(blinks).toBeLessThanOrEqual(seconds / 2);
    expect(shut).toBeLessThan(60 * 30 * 0.1);
  });
});

describe('brows', () => {
  const raised = ({ loaded }: { loaded: LoadedAvatar }) => loaded.vrm.expressionManager?.getValue('surprised');

  test('rise a little while the mouth is open, and come down with it', async () => {
    const body = await opened();
    body.avatar.setMouth(1);
    const time = stand(body.avatar, 0, 2);
    expect(raised(body)).toBeGreaterThan(0.1);
    expect(raised(body)).toBeLessThan(0.5);
    body.avatar.setMouth(0);
    stand(body.avatar, time, 3);
    expect(raised(body)).toBe(0);
  });

  test.each([{ isBinary: true }, { overrideMouth: 'block' }, { overrideBlink: 'blend' }])(
    'stay where the expression %j would take lids or mouth over',
    async (expression) => {
      const body = await opened(defaultCalibration, living(expression));
      body.avatar.setMouth(1);
      stand(body.avatar, 0, 2);
      expect(raised(body)).toBe(0);
    },
  );
});

/** Stands for so long with a mouth that is to be open so far; how far it is then. */
function speak({ loaded, avatar }: Awaited<ReturnType<typeof opened>>, open: number, from: number, seconds: number) {
  avatar.setMouth(open);
  stand(avatar, from, seconds);
  return loaded.vrm.expressionManager?.getValue('aa') ?? Number.NaN;
}

describe('a mouth', () => {
  test('opens with speech within a syllable, never jumps open, and shuts all the way', async () => {
    const body = await opened();
    expect(speak(body, 0, 0, 0.5)).toBe(0);
    const first = speak(body, 1, 0.5, 1 / 72);
    expect(first).toBeGreaterThan(0.1);
    expect(first).toBeLessThan(0.6);
    expect(speak(body, 1, 0.52, 0.15)).toBeGreaterThan(0.9);
    expect(speak(body, 0, 0.7, 0.4)).toBe(0);
  });

  test('is all the way open for more than all, and shut for less than nothing', async () => {
    const body = await opened();
    expect(speak(body, 7, 0, 1)).toBe(1);
    expect(speak(body, -7, 1, 1)).toBe(0);
  });

  test('is shut by what is no number, and opens again with the next number', async () => {
    const body = await opened();
    expect(speak(body, 1, 0, 1)).toBe(1);
    expect(speak(body, Number.NaN, 1, 1)).toBe(0);
    expect(speak(body, Number.POSITIVE_INFINITY, 2, 1)).toBe(1);
  });

  test('has its shape for a head without lids before the first frame, then while open', async () => {
    const avatar = createAvatar(
      await parseAvatar(
        changed(() => undefined),
        'mannequin.vrm',
      ),
    );
    avatar.setCalibration(defaultCalibration);
    const shaped = (): number => {
      let meshes = 0;
      avatar.object.traverse((node) => {
        if ((node as Mesh).geometry?.morphAttributes.position) meshes += 1;
      });
      return meshes;
    };
    const all = shaped();
    expect(all).toBeGreaterThan(0);
    stand(avatar, 0, 1 / 72);
    expect(shaped()).toBe(0);
    avatar.setMouth(0.5);
    stand(avatar, 1, 0.2);
    expect(shaped()).toBe(all);
    avatar.setMouth(0);
    stand(avatar, 2, 1);
    expect(shaped()).toBe(0);
  });

  test.each(['viseme_aa', 'jawOpen', 'mouthOpen'])(
    'moves by the shape %s of a file without expressions, and by one alone',
    async (name) => {
      const file = readFileSync(new URL('../../../public/avatars/woman.vrm', import.meta.url));
      const bytes = changed((json) => {
        delete (json.extensions.VRMC_vrm as unknown as Record<string, unknown>).expressions;
        for (const { extras } of json.meshes) {
          const shapes = extras?.targetNames as string[] | undefined;
          if (shapes) extras!.targetNames = shapes.map((shape, i) => [name, 'MouthOpen'][i] ?? shape);
        }
      }, file);
      const loaded = await parseAvatar(bytes, 'shaped.vrm');
      const avatar = createAvatar(loaded);
      avatar.setCalibration(defaultCalibration);
      avatar.setMouth(1);
      stand(avatar, 0, 1);
      const influences: number[][] = [];
      avatar.object.traverse((node) => {
        const { morphTargetInfluences } = node as Mesh;
        if (morphTargetInfluences) influences.push([...morphTargetInfluences]);
      });
      expect(influences.length).toBeGreaterThan(0);
      for (const [first, ...others] of influences) {
        expect(first).toBe(1);
        expect(others).toEqual(others.map(() => 0));
      }
    },
  );
});
