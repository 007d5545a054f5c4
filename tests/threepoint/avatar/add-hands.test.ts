import {
  Bone,
  CylinderGeometry,
  Float32BufferAttribute,
  Group,
  MeshBasicMaterial,
  type Object3D,
  Skeleton,
  SkinnedMesh,
  Uint16BufferAttribute,
  Vector3,
} from 'three';
import type { BoneName } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { addHands } from '../../../src/threepoint/avatar/humanoid/add-hands';
import { parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { builtRig, type RigOptions } from './built-rig';
import { mixamo, namings } from './rig-namings';
import { hold, skinAt, wear } from './worn-body';

const handless = ['leftHand', 'rightHand'];
const place = (node: { getWorldPosition(target: Vector3): Vector3 }) => node.getWorldPosition(new Vector3());

describe('arms whose fingers leave the forearm', () => {
  const open = async (options: RigOptions, bones?: Readonly<Record<string, string>>) =>
    parseAvatar(builtRig({ without: handless, ...options }), 'person.glb', bones && { bones });

  test.each(namings)('get a hand where the fingers begin, named as %s has them', async (_, nameOf) => {
    const loaded = await open({ nameOf });
    expect(loaded.notes).toHaveLength(2);
    expect(loaded.notes[0]).toMatch(/^no hand follows .*: a joint was made where that arm ends$/);
    const body = wear(loaded);
    const { leftHand } = hold(body.avatar, 11.5);
    const knuckles = skinAt(body, 'leftIndexProximal').reduce((sum, each) => sum.add(each), new Vector3());
    expect(knuckles.divideScalar(8).distanceTo(leftHand!.position as Vector3)).toBeLessThan(0.05);
  });

  test('get one by a map that names no hands', async () => {
    const nameOf = (bone: string) => [...bone].map((letter) => letter.charCodeAt(0) % 7).join('x');
    const named = ['hips', 'spine', 'head', 'leftUpperArm', 'leftLowerArm', 'rightUpperArm', 'rightLowerArm'];
    const { vrm } = await open({ nameOf }, Object.fromEntries(named.map((bone) => [bone, nameOf(bone)])));
    expect(vrm.humanoid.getRawBoneNode('rightHand')).not.toBeNull();
  });
});

describe('arms that end at the forearm', () => {
  /** A forearm of 25 cm of skin that begins at the elbow and hangs down. */
  function forearm() {
    const [upperArm, bone] = [new Bone(), new Bone()];
    upperArm.position.set(0.4, 1.6, 0);
    bone.position.set(0, -0.3, 0);
    upperArm.add(bone);
    const geometry = new CylinderGeometry(0.04, 0.03, 0.25).translate(0, -0.125, 0).translate(0.4, 1.3, 0);
    const { count } = geometry.getAttribute('position');
    const each = (values: readonly number[]) => Array.from({ length: count }, () => values).flat();
    geometry.setAttribute('skinIndex', new Uint16BufferAttribute(each([0, 0, 0, 0]), 4));
    geometry.setAttribute('skinWeight', new Float32BufferAttribute(each([1, 0, 0, 0]), 4));
    const mesh = new SkinnedMesh(geometry, new MeshBasicMaterial());
    const scene = new Group().add(upperArm, mesh);
    scene.updateMatrixWorld(true);
    mesh.bind(new Skeleton([bone]));
    const bones = [['leftUpperArm', upperArm] as const, ['leftLowerArm', bone] as const];
    return { scene, bones: new Map<BoneName, Object3D>(bones) };
  }

  test('get a hand where their skin ends', () => {
    const { scene, bones } = forearm();
    const made = addHands(scene, bones);
    expect(place(made.get('leftHand')!).distanceTo(new Vector3(0.4, 1.05, 0))).toBeLessThan(2e-3);
  });

  test('get none without skin', () => {
    const { scene, bones } = forearm();
    scene.remove(scene.children[1]!);
    expect(addHands(scene, bones).size).toBe(0);
  });

  test('are worn with one hand or none', async () => {
    const fingers = ['Thumb', 'Index', 'Middle', 'Little'];
    const parts = ['Metacarpal', 'Proximal', 'Intermediate', 'Distal'];
    const without = ['left', 'right'].map((side) => [
      `${side}Hand`,
      ...fingers.flatMap((finger) => parts.map((part) => `${side}${finger}${part}`)),
    ]);
    for (const [gone, notes] of [
      [without[0]!, 1],
      [without.flat(), 2],
    ] as const) {
      const loaded = await parseAvatar(builtRig({ nameOf: mixamo('mixamorig:'), without: gone }), 'blob.glb');
      expect(loaded.notes).toHaveLength(notes);
      expect(wear(loaded).avatar.jointPositions()).toBeDefined();
    }
  });
});
