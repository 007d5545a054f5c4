import {
  Bone,
  BufferGeometry,
  Float32BufferAttribute,
  Matrix4,
  MeshBasicMaterial,
  Skeleton,
  SkinnedMesh,
  Uint16BufferAttribute,
} from 'three';
import { CCDIKSolver } from 'three/addons/animation/CCDIKSolver.js';
import type { Skeleton as Body, TrackingFrame } from 'threepoint/core';
import { parentOf } from '../../src/threepoint/core/body/joints';

const chains = [
  { effector: 'head', links: ['neck', 'upperChest', 'chest', 'spine'], target: 'headTarget' },
  { effector: 'leftHand', links: ['leftLowerArm', 'leftUpperArm', 'leftShoulder'], target: 'leftTarget' },
  { effector: 'rightHand', links: ['rightLowerArm', 'rightUpperArm', 'rightShoulder'], target: 'rightTarget' },
] as const;
const iterations = 10;

/** three's own solver on the same chains: head on the spine, two arms. */
export function createCcdBody(body: Body): { solve(frame: TrackingFrame): void } {
  const bones = new Map<string, Bone>();
  for (const [name, parent] of Object.entries(parentOf)) {
    const bone = new Bone();
    const { x, y, z } = body.restOffsets[name as keyof typeof body.restOffsets];
    bone.name = name;
    bone.position.set(x, y, z);
    bones.set(name, bone);
    if (parent) bones.get(parent)?.add(bone);
  }
  for (const { target } of chains) {
    const bone = new Bone();
    bone.name = target;
    bones.set(target, bone);
  }
  const all = [...bones.values()];
  const index = (name: string): number => all.findIndex((bone) => bone.name === name);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute([0, 0, 0, 0, 0, 0, 0, 0, 0], 3));
  geometry.setAttribute('skinIndex', new Uint16BufferAttribute(new Array(12).fill(0), 4));
  geometry.setAttribute('skinWeight', new Float32BufferAttribute([1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0], 4));
  const mesh = new SkinnedMesh(geometry, new MeshBasicMaterial());
  for (const bone of all) if (!bone.parent) mesh.add(bone);
  mesh.updateMatrixWorld(true);
  mesh.bind(
    new Skeleton(
      all,
      all.map((bone) => new Matrix4().copy(bone.matrixWorld).invert()),
    ),
  );
  const solver = new CCDIKSolver(
    mesh,
    chains.map(({ effector, links, target }) => ({
      effector: index(effector),
      target: index(target),
      links: links.map((link) => ({ index: index(link) })),
      iteration: iterations,
    })),
  );
  return {
    solve({ head, leftHand, rightHand }) {
      const hips = bones.get('hips');
      hips?.position.set(head.position.x, body.restOffsets.hips.y, head.position.z);
      for (const [name, pose] of [
        ['headTarget', head],
        ['leftTarget', leftHand],
        ['rightTarget', rightHand],
      ] as const) {
        if (pose) bones.get(name)?.position.set(pose.position.x, pose.position.y, pose.position.z);
      }
      mesh.updateMatrixWorld(true);
      solver.update();
      mesh.updateMatrixWorld(true);
    },
  };
}
