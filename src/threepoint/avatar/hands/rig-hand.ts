import type { VRM } from '@pixiv/three-vrm';
import { type Bone, type Object3D, Quaternion, Vector3 } from 'three';
import { fingerBoneNames } from '../../core/body/finger-bone-names';
import {
  bendFromPoints,
  type FingerPoints,
  fingerFrames,
  type HandGeometry,
  makeFingerFrames,
  makeFingerPoints,
  mirrorRotation,
} from '../../core/body/hand-geometry';
import { type FingerName, fingerNames, makeHandShape } from '../../core/body/hand-shape';
import type { BoneName } from '../../core/humanoid/bones';
import { conjugate, copyQuat, fromAxes, type MutableQuat, multiply, type Quat, quat } from '../../core/math/quat';
import type { Side } from '../../core/math/side';
import {
  add,
  backward,
  distance,
  dot,
  forward,
  normalise,
  right,
  scale,
  setVec3,
  subtract,
  up,
  vec3,
} from '../../core/math/vec3';
import { boneNode } from '../humanoid/needed-bones';
import { skinnedMeshesOf } from '../scene-meshes';

type BoneIndex = 0 | 1 | 2;

/**
 * A bone of a finger. Its node's rotation is before · turned · after, where turned is the rotation since the rest pose
 * relative to the carrying bone, in the frame of the wrist.
 */
interface FingerBone {
  readonly node: Object3D;
  readonly index: BoneIndex;
  /** The bone of the finger that is its parent; null: the hand. */
  readonly carrier: BoneIndex | null;
  readonly before: Quat;
  readonly after: Quat;
}

export interface RigFinger {
  readonly name: FingerName;
  readonly bones: readonly FingerBone[];
  /** The inverse of each bone's frame at rest (hand-geometry). */
  readonly fromRest: readonly [Quat, Quat, Quat];
  /** The fingertip, in the frame of the node of the last bone. */
  readonly tip: Vector3;
}

export interface RigHand {
  readonly fingers: readonly RigFinger[];
  /** The geometry of the hand in the rig's own metres; null: the rig lacks a finger bone. */
  readonly geometry: HandGeometry | null;
}

/**
 * Returns a finger's three nodes from the palm outwards; null: the rig lacks the bone. three-vrm gives thumbs of VRM
 * 0.x the bone names of 1.0.
 */
const nodesOf = (vrm: VRM, side: Side, finger: FingerName): (Object3D | null)[] =>
  fingerBoneNames(side, finger).map((bone) => boneNode(vrm, bone as BoneName));

/** The orientation of a wrist at rest in the rig's frame, which faces +Z, with arms spread and palms down. */
const rigFromWrist: Readonly<Record<Side, Quat>> = {
  left: fromAxes(backward, up, vec3(-1, 0, 0)),
  right: fromAxes(forward, up, right),
};

/** The length of a finger's last bone relative to the one before, if the rig has no end bone. */
const lastBone = 0.8;
/** The radius of a finger without skin relative to the length of its first bone. */
const thickness = 0.22;
/** The ratio of a finger's radius at its root to that at its tip. */
const taper = 1.3;

/** Returns the fingers of one hand of a rig at rest. World matrices must be up to date. */
export function readRigHand(vrm: VRM, side: Side): RigHand {
  const hand = boneNode(vrm, `${side}Hand`);
  const found = hand ? fingerNames.map((name) => readFinger(vrm, side, name, hand)) : [];
  const fingers = found.flatMap(({ finger }) => finger ?? []);
  const geometries = Object.fromEntries(found.map(({ name, geometry }) => [name, geometry]));
  const whole = found.length > 0 && found.every(({ geometry }) => geometry !== null);
  return { fingers, geometry: whole ? (geometries as HandGeometry) : null };
}

function readFinger(vrm: VRM, side: Side, name: FingerName, hand: Object3D) {
  const nodes = nodesOf(vrm, side, name);
  if (!nodes.some(Boolean)) return { name, finger: null, geometry: null };
  const points = makeFingerPoints();
  const skin = skinOf(vrm.scene, nodes[2] ?? null);
  restPoints(nodes, hand, side, points);
  const radius = skin ? endAtSkin(skin, hand, side, points) : null;
  const rest = makeFingerFrames();
  fingerFrames(name, bendFromPoints(name, points, makeHandShape()[name]), rest);
  const fromRest = [conjugate(rest[0]), conjugate(rest[1]), conjugate(rest[2])] as const;
  const [root, second, third, tip] = points;
  const lengths = [distance(root, second), distance(second, third), distance(third, tip)] as const;
  const tipRadius = radius ?? thickness * lengths[0];
  const whole = nodes.every(Boolean);
  return {
    name,
    finger: { name, bones: bonesOf(nodes, side), fromRest, tip: tipOf(points, nodes, hand, side) },
    geometry: whole ? { root, lengths, tipRadius, rootRadius: taper * tipRadius } : null,
  };
}

const world = new Vector3();
const handAt = new Vector3();

/** Transforms a point of the rig into the frame of a left wrist (hand-geometry). */
function placeIn(at: Vector3, hand: Object3D, side: Side, target: FingerPoints[number]): void {
  at.sub(hand.getWorldPosition(handAt));
  setVec3(target, at.z, at.y, side === 'left' ? -at.x : at.x);
}

/** Returns the fingertip in the frame of the last bone that the rig has. */
function tipOf([, , , tip]: FingerPoints, nodes: readonly (Object3D | null)[], hand: Object3D, side: Side): Vector3 {
  const { x, y, z } = tip;
  const inWorld = new Vector3(side === 'left' ? -z : z, y, x).add(hand.getWorldPosition(handAt));
  return nodes.findLast((node) => node !== null)?.worldToLocal(inWorld) ?? inWorld;
}

/** Writes joints and tip by the bones alone; a missing bone lies at the end of the one before. */
function restPoints(nodes: readonly (Object3D | null)[], hand: Object3D, side: Side, points: FingerPoints): void {
  const along = vec3(0, 0, -1);
  let last = 0.03;
  for (const [index, node] of nodes.entries()) {
    const at = points[index as BoneIndex];
    if (node) placeIn(node.getWorldPosition(world), hand, side, at);
    else if (index > 0) add(points[(index - 1) as BoneIndex], scale(along, last), at);
    if (index === 0) continue;
    subtract(at, points[(index - 1) as BoneIndex], along);
    last = distance(at, points[(index - 1) as BoneIndex]);
    normalise(along, undefined, along);
  }
  const end = nodes[2]?.children.find((child) => child.position.lengthSq() > 0);
  if (end) placeIn(end.getWorldPosition(world), hand, side, points[3]);
  else add(points[2], scale(along, lastBone * last), points[3]);
}

/** Returns the skin vertices that move mostly with a bone, world frame [m]; null: there are none. */
function skinOf(scene: Object3D, node: Object3D | null): readonly Vector3[] | null {
  const found: Vector3[] = [];
  if (!node) return null;
  for (const object of skinnedMeshesOf(scene)) {
    const bone = object.skeleton.bones.indexOf(node as Bone);
    if (bone < 0) continue;
    const { skinIndex, skinWeight, position } = object.geometry.attributes;
    if (!skinIndex || !skinWeight || !position) continue;
    // Ten fingers look through all vertices: the array itself is several times as fast as its accessors.
    const { array } = skinIndex;
    for (let v = 0; v < position.count; v++) {
      let fraction = 0;
      for (let slot = 0; slot < 4; slot++) {
        if (array[4 * v + slot] === bone) fraction += skinWeight.getComponent(v, slot);
      }
      if (fraction > 0.5) found.push(object.getVertexPosition(v, new Vector3()).applyMatrix4(object.matrixWorld));
    }
  }
  return found.length >= 4 ? found : null;
}

/** Moves a finger's tip to the centre of the skin's curvature there, and returns its radius [m]. */
function endAtSkin(skin: readonly Vector3[], hand: Object3D, side: Side, points: FingerPoints): number {
  const [, , joint, tip] = points;
  const along = normalise(subtract(tip, joint));
  const at = vec3(0, 0, 0);
  const found = skin.map((vertex) => {
    placeIn(vertex, hand, side, at);
    const from = subtract(at, joint);
    const ahead = dot(from, along);
    return { ahead, aside: Math.sqrt(Math.max(0, dot(from, from) - ahead ** 2)) };
  });
  const furthest = Math.max(...found.map(({ ahead }) => ahead));
  const sides = found.filter(({ ahead }) => ahead > 0.2 * furthest && ahead < 0.8 * furthest);
  const mean = sides.reduce((sum, { aside }) => sum + aside, 0) / sides.length;
  const radius = Math.min(sides.length > 0 ? mean : furthest / 3, furthest / 2);
  if (furthest > radius) add(joint, scale(along, furthest - radius), tip);
  return radius;
}

const restRotation = (node: Object3D): MutableQuat => {
  const { x, y, z, w } = node.getWorldQuaternion(new Quaternion());
  return quat(x, y, z, w);
};

function bonesOf(nodes: readonly (Object3D | null)[], side: Side): readonly FingerBone[] {
  const toRig = rigFromWrist[side];
  return nodes.flatMap((node, index): FingerBone[] => {
    if (!node) return [];
    const carrier = carrierOf(node, nodes, index);
    const parentRest = node.parent ? restRotation(node.parent) : quat(0, 0, 0, 1);
    return [
      {
        node,
        index: index as BoneIndex,
        carrier,
        before: multiply(conjugate(parentRest), toRig),
        after: multiply(conjugate(toRig), restRotation(node)),
      },
    ];
  });
}

/** Returns the nearest ancestor of a node in the same finger. */
function carrierOf(node: Object3D, nodes: readonly (Object3D | null)[], index: number): BoneIndex | null {
  for (let above = index - 1; above >= 0; above--) {
    const candidate = nodes[above];
    for (let up = node.parent; up && candidate; up = up.parent) if (up === candidate) return above as BoneIndex;
  }
  return null;
}

/** Transforms a rotation from the left hand's frame to the frame of this side's wrist. */
export const ofSide = (side: Side, q: MutableQuat, target: MutableQuat): MutableQuat => {
  copyQuat(q, target);
  return side === 'right' ? mirrorRotation(target) : target;
};
