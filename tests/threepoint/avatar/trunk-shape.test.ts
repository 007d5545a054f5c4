import { SkinnedMesh, Vector3 } from 'three';
import { defaultCalibration, type TrackingFrame } from 'threepoint/core';
import { distance } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { type Avatar, createAvatar } from '../../../src/threepoint/avatar/avatar';
import { type LoadedAvatar, parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { pinning } from '../../../src/threepoint/core/estimation/pinning';
import { postures, trackedPostures } from '../../../tools/avatars/try/postures';
import { poseOf } from '../core/estimation/drawn';
import { builtInFile } from './drawn-skin';

const trunk = ['hips', 'spine', 'chest', 'upperChest'];
const sides = ['left', 'right'] as const;
const at = ({ x, y, z }: { x: number; y: number; z: number }) => new Vector3(x, y, z);

/** Calls back with every vertex of the trunk's skin. */
function trunkSkin({ vrm }: LoadedAvatar, each: (mesh: SkinnedMesh, vertex: number) => void): void {
  const nodes = new Set(trunk.map((bone) => vrm.humanoid.getRawBoneNode(bone as never)));
  vrm.scene.traverse((mesh) => {
    if (!(mesh instanceof SkinnedMesh)) return;
    const moves = mesh.skeleton.bones.map((bone) => nodes.has(bone));
    const { skinIndex, skinWeight } = mesh.geometry.attributes;
    for (let vertex = 0; vertex < skinWeight!.count; vertex++) {
      const shares = [0, 1, 2, 3].map((i) =>
        moves[skinIndex!.getComponent(vertex, i)] ? skinWeight!.getComponent(vertex, i) : 0,
      );
      if (shares.reduce((sum, share) => sum + share) > 0.7) each(mesh, vertex);
    }
  });
}

/** Loads a built-in body whose trunk is so many times as wide and deep. */
async function widened(body: string, times: number): Promise<LoadedAvatar> {
  const loaded = await parseAvatar(builtInFile(body), `${body}.vrm`);
  trunkSkin(loaded, ({ geometry }, vertex) => {
    const { position } = geometry.attributes;
    position!.setX(vertex, position!.getX(vertex) * times);
    position!.setZ(vertex, position!.getZ(vertex) * times);
  });
  return loaded;
}

function hold(avatar: Avatar, frame: TrackingFrame, from: number): void {
  avatar.setCalibration(defaultCalibration);
  const ik = createIk(defaultCalibration, { pinning });
  for (let step = 0; step < 20; step++)
    avatar.setPose(poseOf(ik, { ...frame, time: from + step / 20 }), from + step / 20);
  avatar.object.updateMatrixWorld(true);
}

/** How deep a point lies in the drawn trunk [m], along the way from the line of hips and neck. */
function depth(loaded: LoadedAvatar, avatar: Avatar, point: Vector3): number {
  const { hips, neck } = avatar.jointPositions();
  const line = at(neck!).sub(at(hips!));
  const reach = line.length();
  line.normalize();
  const from = (place: Vector3) => {
    const offset = place.sub(at(hips!));
    const height = offset.dot(line);
    return { height, offset: offset.addScaledVector(line, -height) };
  };
  const own = from(point.clone());
  if (own.height < -0.1 || own.height > reach) return Number.NEGATIVE_INFINITY;
  const way = own.offset.clone().normalize();
  let skin = 0;
  trunkSkin(loaded, (mesh, vertex) => {
    const { height, offset } = from(mesh.getVertexPosition(vertex, new Vector3()).applyMatrix4(mesh.matrixWorld));
    if (Math.abs(height - own.height) < 0.03 && offset.dot(way) > 0.94 * offset.length())
      skin = Math.max(skin, offset.length());
  });
  return skin - own.offset.length();
}

describe.each([
  ['woman', 1],
  ['man', 1],
  ['child', 1],
  ['stout', 1],
  ['mannequin', 1],
  ['woman', 1.5],
  ['man', 1.5],
  ['child', 1.5],
  ['stout', 1.5],
  ['mannequin', 1.5],
])('%s, with a trunk %d times as wide', (body, times) => {
  test('keeps hands in place, and elbows at most 1 cm in its trunk', async () => {
    const loaded = await widened(body, times);
    const avatar = createAvatar(loaded);
    for (const [index, { name, frame }] of [...postures, ...trackedPostures].entries()) {
      hold(avatar, frame, 10 * index);
      const joints = avatar.jointPositions();
      for (const side of sides) {
        expect(depth(loaded, avatar, at(joints[`${side}LowerArm`]!)), `${name}, ${side} elbow`).toBeLessThan(0.01);
        const hand = frame[`${side}Hand`]!.position;
        if (name !== 'T-pose')
          expect(distance(joints[`${side}Hand`]!, hand), `${name}, ${side} hand`).toBeLessThan(0.02);
      }
    }
  });
});
