import { Group, Quaternion, Vector3 } from 'three';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { actorFrame, defaultCalibration, type Fingers } from 'threepoint/core';
import { distance } from 'threepoint/math';
import { beforeEach, describe, expect, test, vi } from 'vitest';
import { avatarMotionWriter, loadAvatar } from '../../../src/threepoint/api/three';
import { closedHand, flatHand } from '../../../src/threepoint/core/body/hand-shape';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { builtRig } from '../avatar/built-rig';
import { changed, mannequin } from '../avatar/glb';
import { packedSkin } from '../avatar/packed-skin';
import { vroid } from '../avatar/rig-namings';

import { poseOf } from '../core/estimation/drawn';

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

  test('is read from bytes within others, as Node’s Buffer has them, where they lie', async () => {
    const bytes = new Uint8Array(mannequin());
    const wider = new Uint8Array(bytes.length + 200);
    wider.set(bytes, 100);
    const avatar = await loadAvatar(wider.subarray(100, 100 + bytes.length));
    expect(avatar.object.children.length).toBeGreaterThan(0);
  });

  test('stands on a map of its bones where its file is a humanoid without VRM', async () => {
    const [own, other] = [await loadAvatar(mannequin()), await loadAvatar(foreign, { bones })];
    const pose = poseOf(createIk(defaultCalibration), actorFrame(1, defaultCalibration));
    const wrist = (avatar: typeof own) => {
      avatar.setCalibration(defaultCalibration);
      avatar.setPose(pose, 1);
      return avatar.jointPositions().leftHand!;
    };
    expect(distance(wrist(own), pose.leftHand!.position)).toBeLessThan(0.001);
    expect(distance(wrist(other), wrist(own))).toBeLessThan(1e-6);
  });

  test('bends its fingers as the pose says, which another page may have sent', async () => {
    const avatar = await loadAvatar(mannequin());
    avatar.setCalibration(defaultCalibration);
    const pose = poseOf(createIk(defaultCalibration), actorFrame(1, defaultCalibration));
    const reach = (fingers: Fingers) => {
      avatar.setPose(JSON.parse(JSON.stringify({ ...pose, fingers })), 1);
      const { leftHand } = avatar.jointPositions();
      return distance(avatar.fingertips('left').middle!, leftHand!);
    };
    const flat = reach({ left: flatHand, right: flatHand });
    expect(flat).toBeGreaterThan(0.15);
    expect(reach({ left: closedHand, right: flatHand })).toBeLessThan(0.6 * flat);
  });

  test('carries an item in the axes of the wrist and hides it with a lost hand', async () => {
    const avatar = await loadAvatar(mannequin());
    avatar.setCalibration(defaultCalibration);
    const [sword, hat] = [new Group(), new Group()];
    avatar.attach(sword, 'rightHand');
    avatar.attach(hat, 'head');
    const pose = poseOf(createIk(defaultCalibration), actorFrame(1, defaultCalibration));
    avatar.setPose(pose, 1);
    const { position, orientation } = pose.rightHand!;
    avatar.object.updateMatrixWorld(true);
    expect(distance(sword.getWorldPosition(new Vector3()), position)).toBeLessThan(0.001);
    expect(sword.getWorldQuaternion(new Quaternion())).toBeSameRotationAs(orientation, 0.1);
    expect(distance(sword.getWorldScale(new Vector3()), { x: 1, y: 1, z: 1 })).toBeLessThan(1e-9);
    expect(hat.getWorldQuaternion(new Quaternion())).toBeSameRotationAs(pose.head.orientation, 0.1);
    avatar.setPose({ ...pose, body: null, rightHand: null }, 1.1);
    expect([sword.parent!.visible, hat.parent!.visible]).toEqual([false, true]);
    sword.removeFromParent();
    avatar.setPose(pose, 1.2);
    expect(sword.parent).toBeNull();
  });

  test.each([
    ['a VRM', () => loadAvatar(mannequin())],
    ['another humanoid', () => loadAvatar(foreign, { bones })],
  ])('has the nodes of its bones and its VRM (%s)', async (_, load) => {
    const avatar = await load();
    avatar.setPose(poseOf(createIk(defaultCalibration), actorFrame(1, defaultCalibration)), 1);
    avatar.object.updateMatrixWorld(true);
    const wrist = avatar.getBone('leftHand')!.getWorldPosition(new Vector3());
    expect(distance(wrist, avatar.jointPositions().leftHand!)).toBeLessThan(1e-6);
    expect(avatar.getBone('jaw')).toBeNull();
    expect(avatar.vrm.scene.parent).toBe(avatar.object);
  });

  test('is read from a compressed file with the decoders of the page’s GLTFLoader', async () => {
    const file = await packedSkin(builtRig({ nameOf: vroid }));
    await expect(loadAvatar(file)).rejects.toThrow('is compressed (EXT_meshopt_compression)');
    const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
    expect((await loadAvatar(file, { loader })).height).toBeGreaterThan(1);
    await expect(avatarMotionWriter(file)).rejects.toThrow('is compressed (EXT_meshopt_compression)');
    expect((await avatarMotionWriter(file, { loader })).extension).toBe('glb');
  });

  test('is refused with a map that has a missing name or lacks a bone', async () => {
    await expect(loadAvatar(foreign, { bones: { ...bones, leftHand: 'Paw' } })).rejects.toThrow(
      'the avatar: bones.leftHand: no node is called “Paw”',
    );
    const { leftHand, ...handless } = bones;
    expect(leftHand).toBeDefined();
    await expect(loadAvatar(foreign, { bones: handless })).rejects.toThrow('its humanoid has no leftHand');
  });

  test.each(Object.entries({ loadAvatar, avatarMotionWriter: avatarMotionWriter }))(
    'is refused by %s when it has not arrived whole',
    async (_, take) => {
      await expect(take(mannequin().slice(0, -4))).rejects.toThrow(
        /^the avatar: not a VRM or GLB file \(.*truncated\)$/,
      );
    },
  );
});
