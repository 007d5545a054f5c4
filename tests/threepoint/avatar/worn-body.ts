import { type SkinnedMesh, Vector3 } from 'three';
import { actorFrame, type BoneName, defaultCalibration, handBoneRotation, type TrackingFrame } from 'threepoint/core';
import { distance, down, rotate, vec3 } from 'threepoint/math';
import { expect } from 'vitest';
import { type Avatar, createAvatar } from '../../../src/threepoint/avatar/avatar';
import { type LoadedAvatar, parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { poseOf } from '../core/estimation/drawn';
import { boxHalf, builtRig, type RigOptions } from './built-rig';

/** A body from a file, on an adult of 1.70 m. */
export interface Worn {
  readonly loaded: LoadedAvatar;
  readonly avatar: Avatar;
}

export function wear(loaded: LoadedAvatar): Worn {
  const avatar = createAvatar(loaded);
  avatar.setCalibration(defaultCalibration);
  return { loaded, avatar };
}

export const opened = async (options: RigOptions): Promise<Worn> =>
  wear(await parseAvatar(builtRig(options), 'person.glb'));

function skinOf(avatar: Avatar): SkinnedMesh {
  let found: SkinnedMesh | null = null;
  avatar.object.traverse((node) => {
    if ('isSkinnedMesh' in node && !node.name.includes('erase')) found = node as SkinnedMesh;
  });
  if (!found) throw new Error('a body without skin');
  return found;
}

/** The corners of the box of skin that is bound to a bone, as drawn, floor frame [m]. */
export function skinAt({ loaded, avatar }: Worn, bone: BoneName): Vector3[] {
  avatar.object.updateMatrixWorld(true);
  const mesh = skinOf(avatar);
  const node = loaded.vrm.humanoid.getRawBoneNode(bone as never);
  const index = mesh.skeleton.bones.indexOf(node as never);
  if (index < 0) throw new Error(`no skin is bound to ${bone}`);
  return Array.from({ length: 8 }, (_, corner) =>
    mesh.getVertexPosition(index * 8 + corner, new Vector3()).applyMatrix4(mesh.matrixWorld),
  );
}

const middle = (corners: readonly Vector3[]): Vector3 =>
  corners.reduce((sum, corner) => sum.add(corner), new Vector3()).divideScalar(corners.length);

/** Arms stretched out, then hands before the chest: shows where skin lies in both. */
export function hold(avatar: Avatar, seconds: number): TrackingFrame {
  const ik = createIk(defaultCalibration);
  const frame = actorFrame(seconds, defaultCalibration);
  for (let step = 0; step < 30; step++) avatar.setPose(poseOf(ik, { ...frame, time: step / 30 }), step / 30);
  return frame;
}

/** What must be true of every body that is worn, from any file. */
export function expectBody(body: Worn): void {
  for (const second of [1, 11.5, 20]) {
    const { leftHand, rightHand, head } = hold(body.avatar, second);
    for (const [side, hand] of [
      ['left', leftHand],
      ['right', rightHand],
    ] as const) {
      const { position, orientation } = hand!;
      expect(distance(middle(skinAt(body, `${side}Hand`)), position), `${side} wrist`).toBeLessThan(1e-3);
      const knuckle = middle(skinAt(body, `${side}IndexProximal`));
      const along = new Vector3().subVectors(knuckle, position as Vector3).normalize();
      const wrist = rotate(handBoneRotation(side, orientation), vec3(side === 'left' ? -1 : 1, 0, 0));
      expect(along.dot(wrist as Vector3), `${side} index finger points as the hand does`).toBeGreaterThan(0.9);
      const little = middle(skinAt(body, `${side}LittleProximal`));
      const palm = rotate(orientation, down);
      const across = new Vector3().subVectors(knuckle, little).normalize();
      expect(Math.abs(across.dot(palm as Vector3)), `${side} palm`).toBeLessThan(0.25);
    }
    const face = middle(skinAt(body, 'head'));
    expect(distance(face, head.position), 'head').toBeLessThan(0.2);
    const corners = skinAt(body, 'head');
    const size = corners[0]!.distanceTo(corners[1]!);
    expect(size, 'the head is as large as the wearer').toBeGreaterThan(boxHalf);
    expect(size).toBeLessThan(4 * boxHalf);
  }
}
