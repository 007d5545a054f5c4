import {
  Bone,
  BufferGeometry,
  Float32BufferAttribute,
  Matrix4,
  MeshBasicMaterial,
  Skeleton,
  SkinnedMesh,
  Uint16BufferAttribute,
  Vector3,
} from 'three';
import { CCDIKSolver } from 'three/addons/animation/CCDIKSolver.js';
import type { Skeleton as Body, TrackingFrame } from 'threepoint/core';
import { add, rotate, subtract, type Vec3, vec3 } from 'threepoint/math';
import { headJointOf } from '../../src/threepoint/core/body/head-joint';
import { parentOf } from '../../src/threepoint/core/body/joints';
import { headingOf } from '../../src/threepoint/core/tracking/heading';

const chains = [
  { effector: 'head', links: ['neck', 'upperChest', 'chest', 'spine'], target: 'headTarget' },
  { effector: 'leftHand', links: ['leftLowerArm', 'leftUpperArm', 'leftShoulder'], target: 'leftTarget' },
  { effector: 'rightHand', links: ['rightLowerArm', 'rightUpperArm', 'rightShoulder'], target: 'rightTarget' },
] as const;
const iterations = 10;

/** A body of three's own solver; `joints`: places of all joints [m], floor frame. */
interface CcdBody {
  solve(frame: TrackingFrame): void;
  joints(): Readonly<Record<string, Vec3>>;
}

/** The path from the hips to the head joint in T-pose [m]. */
function hipsToHead({ restOffsets: { spine, chest, upperChest, neck, head } }: Body): Vec3 {
  return [spine, chest, upperChest, neck, head].reduce((sum, offset) => add(sum, offset), vec3(0, 0, 0));
}

/**
 * three's own solver on the same chains: head on the spine, two arms. The hips stand below the head and face where it
 * does. A hand that is not seen stays where it was seen last.
 */
export function createCcdBody(body: Body): CcdBody {
  const toHead = hipsToHead(body);
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
      const headJoint = headJointOf(head, body.eyesInHead);
      const heading = headingOf(head.orientation);
      const hips = bones.get('hips');
      hips?.position.copy(subtract(headJoint, rotate(heading, toHead)));
      hips?.quaternion.copy(heading);
      bones.get('headTarget')?.position.copy(headJoint);
      if (leftHand) bones.get('leftTarget')?.position.copy(leftHand.position);
      if (rightHand) bones.get('rightTarget')?.position.copy(rightHand.position);
      mesh.updateMatrixWorld(true);
      solver.update();
      mesh.updateMatrixWorld(true);
    },
    joints: () =>
      Object.fromEntries(
        Object.keys(parentOf).map((name) => [name, new Vector3().setFromMatrixPosition(bones.get(name)!.matrixWorld)]),
      ),
  };
}
