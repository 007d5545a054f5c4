import { readFileSync } from 'node:fs';
import { Euler, Mesh, type MeshStandardMaterial, SkinnedMesh } from 'three';
import {
  type AvatarHash,
  type AvatarRef,
  actorFrame,
  type BuiltInBody,
  bodyOf,
  builtInAvatarOf,
  defaultAvatar,
  defaultCalibration,
  forwardKinematics,
  isBuiltInAvatar,
  type RemotePerson,
  skeletonFromCalibration,
  TransientError,
} from 'threepoint/core';
import { distance, fromAxisAngle, transformPoint, up, vec3 } from 'threepoint/math';
import { describe, expect, onTestFinished, test } from 'vitest';
import { createAvatarBetweenFrames } from '../../../src/threepoint/avatar/avatar';
import { GazeTargets } from '../../../src/threepoint/avatar/gaze-targets';
import { parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { RemoteAvatars } from '../../../src/threepoint/avatar/remote-avatars';
import { FlatPartsMaterial } from '../../../src/threepoint/avatar/rig/flat-parts';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { poseOf } from '../core/estimation/drawn';

function bytesOf(body: BuiltInBody): ArrayBuffer {
  const file = readFileSync(new URL(`../../../public/avatars/${body}.vrm`, import.meta.url));
  return file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength) as ArrayBuffer;
}
const load = async (body: BuiltInBody) => createAvatarBetweenFrames(await parseAvatar(bytesOf(body), body));
const estimator = createIk(defaultCalibration);

const person = (id: number, more: Partial<RemotePerson> = {}): RemotePerson => ({
  id,
  calibration: defaultCalibration,
  avatar: defaultAvatar,
  palette: 'ember',
  pose: poseOf(estimator, actorFrame(9.5, defaultCalibration)),
  placement: { position: vec3(id, 0, -2 * id), orientation: fromAxisAngle(up, 0.7 * id) },
  opacity: 1,
  ...more,
});

/** Draws these people until each of them has a body. */
async function gathered(
  people: readonly RemotePerson[],
  options: { gazeTargets?: GazeTargets; idles?(): boolean } = {},
): Promise<RemoteAvatars> {
  const others = new RemoteAvatars<AvatarRef>({
    load: (avatar) => (isBuiltInAvatar(avatar) ? load(bodyOf(avatar)) : Promise.reject(avatar)),
    plain: defaultAvatar,
    mouthOf: () => 0,
    ...options,
    onRefused: (avatar, reason) => expect([avatar, reason]).toBeNull(),
  });
  for (let i = 0; i < 5000 && !people.every(({ id, avatar }) => others.drawnAs(id) === avatar); i++) {
    others.show(people, i / 60);
    await new Promise((resolve) => setTimeout(resolve));
  }
  others.show(people, 10);
  return others;
}

describe('bodies of others', () => {
  test('stand where their floor lies, joint by joint as they were solved', async () => {
    const people = [person(1), person(2)];
    const others = await gathered(people);
    for (const { id, pose, placement } of people) {
      if (!pose.body) throw new Error('IK draws a body');
      const solved = forwardKinematics(skeletonFromCalibration(defaultCalibration), pose.body);
      for (const name of ['head', 'leftLowerArm', 'rightLowerArm', 'rightHand'] as const) {
        const drawn = others.jointsOf(id)?.[name];
        expect(drawn && distance(drawn, transformPoint(placement, solved[name].position))).toBeLessThan(1e-6);
      }
    }
    others.dispose();
  });

  test('turn their eyes to the head before their face, and ahead once it has gone', async () => {
    const facing = { position: vec3(0.3, 0, -2), orientation: fromAxisAngle(up, Math.PI) };
    const avatar = builtInAvatarOf('woman', 'tan');
    const placement = { position: vec3(0, 0, 0), orientation: fromAxisAngle(up, 0) };
    const head = { position: vec3(0, 1.59, 0), orientation: fromAxisAngle(up, 0), tracking: 'tracked' as const };
    const pose = poseOf(estimator, { ...actorFrame(9.5, defaultCalibration), head });
    const people = [person(1, { avatar, pose, placement }), person(2, { avatar, pose, placement: facing })];
    const others = await gathered(people);
    const eyeYaw = () => {
      const yaws: number[] = [];
      others.object.traverse((node) => {
        if (node.name === 'leftEye') yaws.push(new Euler().setFromQuaternion(node.quaternion, 'YXZ').y);
      });
      return yaws;
    };
    for (let i = 1; i < 60; i++) others.show(people, 10 + i / 60);
    const [first, second] = eyeYaw();
    // Each is to the right of where the other's face points, by 8.5 degrees.
    expect(first).toBeCloseTo(-0.149, 2);
    expect(second).toBeCloseTo(-0.149, 2);
    for (let i = 1; i < 60; i++) others.show(people.slice(0, 1), 11 + i / 60);
    expect(eyeYaw()[0]).toBeCloseTo(0, 3);
    others.dispose();
  });

  test('turn their eyes to what the page adds, and to each other without it', async () => {
    const head = { position: vec3(0, 1.59, 0), orientation: fromAxisAngle(up, 0), tracking: 'tracked' as const };
    const pose = poseOf(estimator, { ...actorFrame(9.5, defaultCalibration), head });
    const placement = { position: vec3(0, 0, 0), orientation: fromAxisAngle(up, 0) };
    const gazeTargets = new GazeTargets();
    const alone = [person(1, { avatar: builtInAvatarOf('woman', 'tan'), pose, placement })];
    const others = await gathered(alone, { gazeTargets });
    const eye = others.object.getObjectByName('leftEye')!;
    for (let i = 1; i < 60; i++) {
      gazeTargets.clear();
      gazeTargets.add('ball', vec3(-0.3, 1.59, -2));
      others.show(alone, 10 + i / 60);
    }
    expect(new Euler().setFromQuaternion(eye.quaternion, 'YXZ').y).toBeCloseTo(0.149, 2);
    others.dispose();
  });

  test('breathe and shift their weight while the page wants it, with head and hands in place', async () => {
    let idle = true;
    const people = [person(1)];
    const others = await gathered(people, { idles: () => idle });
    const joint = (name: string) => ({ ...others.jointsOf(1)![name]! });
    const names = ['hips', 'chest', 'head', 'leftHand', 'rightHand'];
    const reachOver = (from: number) => {
      const first = names.map(joint);
      const reach = names.map(() => 0);
      for (let i = 1; i < 600; i++) {
        others.show(people, from + i / 60);
        names.forEach((name, k) => {
          reach[k] = Math.max(reach[k]!, distance(joint(name), first[k]!));
        });
      }
      return Object.fromEntries(names.map((name, k) => [name, reach[k]!]));
    };
    const living = reachOver(10);
    expect(living.hips).toBeGreaterThan(0.002);
    expect(living.chest).toBeGreaterThan(0.001);
    for (const name of ['head', 'leftHand', 'rightHand']) expect(living[name]).toBeLessThan(5e-4);
    idle = false;
    for (let i = 0; i < 300; i++) others.show(people, 20 + i / 60);
    expect(Math.max(...Object.values(reachOver(25)))).toBeLessThan(1e-6);
    others.dispose();
  });

  const unlike: Record<string, readonly [Partial<RemotePerson>, Partial<RemotePerson>]> = {
    palettes: [{ palette: 'ember' }, { palette: 'moss' }],
    'tones of skin': [{ avatar: builtInAvatarOf('woman', 'fair') }, { avatar: builtInAvatarOf('woman', 'dark') }],
  };
  test.each(Object.entries(unlike))('share vertices, not colours: %s', async (_, [one, other]) => {
    const others = await gathered([person(1, one), person(2, other)]);
    const bodies = others.object.children.filter(({ visible }) => visible);
    const skins: SkinnedMesh[][] = bodies.map((place) => {
      const found: SkinnedMesh[] = [];
      place.traverse((node) => {
        if (node instanceof SkinnedMesh) found.push(node);
      });
      return found;
    });
    const [first = [], second = []] = skins;
    expect(first.length).toBeGreaterThan(0);
    first.forEach((mesh, i) => {
      expect(second[i]?.geometry.getAttribute('position')).toBe(mesh.geometry.getAttribute('position'));
      expect(second[i]?.geometry.index).toBe(mesh.geometry.index);
    });
    const suits = skins.map((meshes) =>
      meshes
        .flatMap(({ material }) => material as MeshStandardMaterial | MeshStandardMaterial[])
        .flat()
        .flatMap((material) => (material instanceof FlatPartsMaterial ? material.parts : [material]))
        .map(({ name, color }) => `${name} ${color.getHexString()}`),
    );
    expect(suits[0]).not.toEqual(suits[1]);
    others.dispose();
  });

  test('fade to a ghost, go when no one is passed, and serve the next person', async () => {
    const others = await gathered([person(1)]);
    others.show([person(1, { opacity: 0.35 })], 11);
    const materials: MeshStandardMaterial[] = [];
    others.object.traverse((node) => {
      if (node instanceof SkinnedMesh) materials.push(...[node.material as MeshStandardMaterial].flat());
    });
    expect(materials.every(({ opacity, transparent }) => opacity === 0.35 && transparent)).toBe(true);
    others.show([], 12);
    expect(others.object.children.every(({ visible }) => !visible)).toBe(true);
    expect(others.jointsOf(1)).toBe(null);
    others.show([person(5)], 13);
    expect(others.jointsOf(5)).not.toBe(null);
    expect(others.object.children).toHaveLength(1);
    expect(others.object.children[0]?.visible).toBe(true);
    expect(materials.every(({ opacity }) => opacity === 1)).toBe(true);
    const [place] = others.object.children;
    expect(place?.children.some((child) => child instanceof Mesh)).toBe(true);
    others.dispose();
  });
});

describe('an avatar that could not be had', () => {
  const file = 'A'.repeat(43) as AvatarHash;

  /**
   * One person with this file on; `answers`: what becomes of each attempt to have it, the last one of all that follow.
   */
  function wearing(answers: readonly (Error | null)[]) {
    const reported: string[] = [];
    let attempts = 0;
    const others = new RemoteAvatars<AvatarRef>({
      async load(avatar: AvatarRef) {
        if (avatar === file) {
          const fault = answers[Math.min(attempts, answers.length - 1)];
          attempts += 1;
          if (fault) throw fault;
        }
        return load('mannequin');
      },
      plain: defaultAvatar,
      mouthOf: () => 0,
      onRefused: (_, reason) => reported.push((reason as Error).message),
    });
    onTestFinished(() => others.dispose());
    /** Frames at this time, until this is true or so many have been drawn. */
    const show = async (time: number, isTrue: () => boolean, most = 5000) => {
      for (let i = 0; i < most && !isTrue(); i++) {
        others.show([person(1, { avatar: file })], time);
        await new Promise((resolve) => setTimeout(resolve));
      }
    };
    return { others, reported, show, attempts: () => attempts };
  }

  test('for a fault that passes is shown once it has loaded, and no mannequin is reported', async () => {
    const { others, reported, show, attempts } = wearing([new TransientError('the server answers 404'), null]);
    await show(0, () => attempts() === 1 && others.drawnAs(1) === defaultAvatar);
    await show(4, () => attempts() > 1, 100);
    expect([attempts(), others.drawnAs(1)]).toEqual([1, defaultAvatar]);
    await show(6, () => others.drawnAs(1) === file);
    expect([attempts(), others.drawnAs(1)]).toEqual([2, file]);
    expect(reported).toEqual([]);
  });

  test('for a fault that does not pass soon is reported once, and requested again and again', async () => {
    const { reported, show, attempts } = wearing([new TransientError('the server answers 404')]);
    for (let attempt = 1; attempt <= 6; attempt++) await show(10 * attempt, () => attempts() === attempt);
    expect(attempts()).toBe(6);
    expect(reported).toEqual(['the server answers 404']);
  });

  test('for its own faults is reported at once and not requested again', async () => {
    const { others, reported, show, attempts } = wearing([new Error('no humanoid')]);
    await show(0, () => attempts() === 1 && others.drawnAs(1) === defaultAvatar);
    await show(60, () => attempts() > 1, 100);
    expect([attempts(), reported]).toEqual([1, ['no humanoid']]);
  });
});
