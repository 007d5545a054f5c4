import { readFileSync } from 'node:fs';
import { type Mesh, type Object3D, PropertyBinding, Vector3, type WebGLRenderer } from 'three';
import { actorFrame, createEstimator, defaultCalibration } from 'threepoint/core';
import { palettes, skinColors } from 'threepoint/internal/three';
import { distance } from 'threepoint/math';
import { type Avatar, BodyTracker } from 'threepoint/three';
import { describe, expect, test } from 'vitest';
import { createPreferenceStore } from '../../../../src/page/shell/session/preferences';
import type { SessionParts } from '../../../../src/page/shell/session/session-parts';
import { AvatarLoader } from '../../../../src/page/shell/stage/avatar-loader';
import { BoneMapStore } from '../../../../src/page/shell/stage/bone-map-store';
import { UserAvatar } from '../../../../src/page/shell/stage/user-avatar';
import { builtRig, rigJoints } from '../../../threepoint/avatar/built-rig';
import { checkFilesHere } from '../../../threepoint/avatar/checked-here';
import { colourOfMaterial } from '../../../threepoint/avatar/material-colour';
import { smallOldVrm, smallVrm } from '../../../threepoint/avatar/small-vrms';
import { poseOf } from '../../../threepoint/core/estimation/drawn';
import { fake } from '../fake';

const file = readFileSync(new URL('../../../../public/avatars/woman.vrm', import.meta.url));
const bytes = () =>
  Promise.resolve(file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength) as ArrayBuffer);
const clothes = (palette: string) => palettes.find(({ name }) => name === palette)?.color;

/** A tracker without a session and, so far, without an avatar. */
const createTracker = () =>
  new BodyTracker<Avatar | null>({ xr: {} } as WebGLRenderer, {
    avatar: null,
    estimator: 'ik',
    calibration: defaultCalibration,
  });

const noBones = () => new BoneMapStore(createPreferenceStore(null));

test('our body keeps its seat’s colours when another replaces it, and its tone of skin', async () => {
  const tracker = createTracker();
  const parts = fake<SessionParts>({
    tracker,
    settings: { palette: 'porcelain', upperBodyOnly: false, builtInBody: 'woman', skinTone: 'dark' },
    notices: { show: (_: unknown, text: string) => expect(text).toBeNull(), withdraw: () => undefined },
    onChange: () => undefined,
  });
  const avatar = new UserAvatar(parts, new AvatarLoader(noBones(), () => Promise.resolve()));
  const colourOf = (material: string) => colourOfMaterial(tracker.object, material);
  await avatar.openBuiltIn(bytes());
  expect([colourOf('Top'), colourOf('Skin')]).toEqual([clothes('porcelain'), skinColors.dark]);
  avatar.setSeatPalette('ember');
  await avatar.openBuiltIn(bytes());
  expect([colourOf('Top'), colourOf('Skin')]).toEqual([clothes('ember'), skinColors.dark]);
  expect(avatar.worn).toBe('woman-dark');
  avatar.setSeatPalette(null);
  expect(colourOf('Top')).toBe(clothes('porcelain'));
});

test('our body has its own colours until a seat chooses others, and afterwards', async () => {
  const { avatar, tracker } = wardrobe();
  await avatar.openBuiltIn(bytes());
  const colours = () => ['Top', 'Bottom', 'Hair'].map((material) => colourOfMaterial(tracker.object, material));
  const own = colours();
  expect(palettes.map(({ color }) => color)).not.toContain(own[0]);
  avatar.setSeatPalette('ember');
  expect(colours()).toEqual([clothes('ember'), expect.not.stringContaining(own[1] ?? ''), own[2]]);
  avatar.setSeatPalette(null);
  expect(colours()).toEqual(own);
});

/** Bones of unknown names that all hang from the armature: neither names nor structure show a humanoid. */
const unknownNames = (name: string) => {
  const parents = Object.fromEntries(rigJoints({}).map(({ bone }) => [bone, null]));
  return new File([builtRig({ nameOf: (bone) => [...bone].reverse().join(''), parents })], name);
};

function wardrobe(prepare: (object: Object3D) => Promise<void> = () => Promise.resolve(), boneMaps = noBones()) {
  const told: string[] = [];
  const withdrawn: string[] = [];
  const tracker = createTracker();
  const parts = fake<SessionParts>({
    tracker,
    settings: { palette: 'own', upperBodyOnly: false, builtInBody: 'woman', skinTone: undefined },
    notices: {
      show: (_: unknown, text: string) => void told.push(text),
      withdraw: (of: string) => void withdrawn.push(of),
    },
    onChange: () => undefined,
  });
  const avatar = new UserAvatar(parts, new AvatarLoader(boneMaps, prepare));
  return { avatar, told, withdrawn, tracker };
}

describe('several files requested in turn', () => {
  test('one that another has taken the place of asks for no bones', async () => {
    const letGo = checkFilesHere('first.glb');
    const { avatar } = wardrobe();
    const first = avatar.open(unknownNames('first.glb'));
    await expect.poll(() => avatar.pending).toContain('being checked');
    expect(await avatar.openBuiltIn(bytes())).toBe(true);
    letGo('first.glb');
    expect(await first).toBe(false);
    expect(avatar.waiting).toBeNull();
    expect(avatar.pending).toBeNull();
  });

  test('one that was given up leaves the next its question for bones', async () => {
    const letGo = checkFilesHere('first.glb');
    const { avatar } = wardrobe();
    const first = avatar.open(unknownNames('first.glb'));
    await expect.poll(() => avatar.pending).toContain('being checked');
    avatar.cancel();
    expect(await avatar.open(unknownNames('second.glb'))).toBe(false);
    expect(avatar.waiting?.name).toBe('second.glb');
    letGo('first.glb');
    await first;
    expect(avatar.waiting?.name).toBe('second.glb');
  });
});

test('a body that is shown withdraws the notice about one that could not be', async () => {
  checkFilesHere();
  const { avatar, told, withdrawn } = wardrobe();
  expect(await avatar.open(unknownNames('first.glb'))).toBe(false);
  expect([told.length, withdrawn]).toEqual([1, []]);
  expect(await avatar.openBuiltIn(bytes())).toBe(true);
  expect(withdrawn).toEqual(['avatar']);
});

test('a body from a file that reaches the graphics device only in part leaves nothing there', async () => {
  checkFilesHere();
  let held = 0;
  const { avatar, told } = wardrobe(async (object) => {
    object.traverse((node) => {
      const { geometry } = node as Mesh;
      if (!geometry) return;
      held += 1;
      geometry.addEventListener('dispose', () => {
        held -= 1;
      });
    });
    expect(held).toBeGreaterThan(0);
    throw new Error('the graphics device is full');
  });
  expect(await avatar.open(new File([await bytes()], 'woman.vrm'))).toBe(false);
  expect(told).toEqual([expect.stringContaining('the graphics device is full')]);
  expect(held).toBe(0);
});

describe('a file that is worn with a wrong bone', () => {
  const rig = builtRig({ nameOf: (bone) => `the ${bone}` });
  const right = { leftHand: 'the leftHand', rightHand: 'the rightHand' };
  const wrong = { leftHand: 'the leftIndexProximal', rightHand: 'the rightIndexProximal' };

  const pose = poseOf(createEstimator('ik', defaultCalibration), actorFrame(9.5, defaultCalibration));

  /**
   * Returns the distance of a bone of the file from the left hand of the body that is drawn [m]: up to 2 cm where a
   * constraint of the file turns the bone above it.
   */
  function fromHand({ current }: UserAvatar, bone: string): number {
    current!.setPose(pose, 0);
    const node = current!.object.getObjectByName(PropertyBinding.sanitizeNodeName(bone))!;
    return distance(node.getWorldPosition(new Vector3()), current!.jointPositions().leftHand!);
  }

  test.each([
    ['GLB', 'rig.glb', rig, 'the '],
    ['VRM 1.0', 'rig.vrm', smallVrm, ''],
    ['VRM 0.x', 'old.vrm', smallOldVrm, ''],
  ])('is corrected as %s, keeps the correction, and goes back', async (_, name, content, prefix) => {
    checkFilesHere();
    const store = createPreferenceStore(null);
    const { avatar, told } = wardrobe(undefined, new BoneMapStore(store));
    const open = () => avatar.open(new File([content], name));
    const named = (map: Readonly<Record<string, string>>) =>
      Object.fromEntries(Object.entries(map).map(([part, bone]) => [part, bone.replace('the ', prefix)]));
    await open();
    expect(avatar.canCorrectBones).toBe(true);
    await avatar.correctBones();
    expect(avatar.waiting).toMatchObject({ isShown: true, canForgetMap: false, bones: named(right) });
    expect(avatar.canCorrectBones).toBe(false);
    expect(await avatar.applyBones({ ...avatar.waiting!.bones, ...named(wrong) })).toBe(true);
    expect(fromHand(avatar, `${prefix}leftIndexProximal`)).toBeLessThan(0.02);
    expect(avatar.waiting).toBeNull();

    // Others get a file that needs no map, and the file is known when it is opened again.
    const sent = wardrobe().avatar;
    await sent.open(new File([await avatar.file()], name));
    expect(fromHand(sent, prefix ? 'leftHand' : 'leftIndexProximal')).toBeLessThan(0.02);
    await avatar.openBuiltIn(bytes());
    expect(avatar.canCorrectBones).toBe(false);
    await open();
    expect(fromHand(avatar, `${prefix}leftIndexProximal`)).toBeLessThan(0.02);

    await avatar.correctBones();
    expect(avatar.waiting).toMatchObject({ canForgetMap: true, confidence: {}, bones: named(wrong) });
    expect(await avatar.applyBones(null)).toBe(true);
    expect(fromHand(avatar, `${prefix}leftHand`)).toBeLessThan(0.02);
    expect(fromHand(avatar, `${prefix}leftIndexProximal`)).toBeGreaterThan(0.03);
    expect(store.preferences.bones).toEqual({});
    expect(told).toEqual([]);
  });

  test('stays as it is worn where the correction is cancelled, or its map does not fit', async () => {
    checkFilesHere();
    const { avatar } = wardrobe();
    await avatar.open(new File([smallVrm], 'rig.vrm'));
    const before = avatar.current;
    await avatar.correctBones();
    const { leftFoot: _, ...footless } = avatar.waiting!.bones;
    expect(await avatar.applyBones(footless)).toBe(false);
    expect(avatar.waiting?.complaint).toBe('a VRM needs its legs: no leftFoot');
    avatar.cancel();
    expect(avatar.current).toBe(before);
    expect(avatar.canCorrectBones).toBe(true);
  });

  test('offers no bones that are read after another avatar was chosen', async () => {
    checkFilesHere();
    const { avatar } = wardrobe();
    await avatar.open(new File([rig], 'rig.glb'));
    const reading = avatar.correctBones();
    expect(await avatar.openBuiltIn(bytes())).toBe(true);
    await reading;
    expect(avatar.waiting).toBeNull();
  });
});
