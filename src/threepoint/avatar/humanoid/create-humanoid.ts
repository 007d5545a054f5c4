import { VRM, VRMFirstPerson, type VRMHumanBones, VRMHumanoid } from '@pixiv/three-vrm';
import { type Group, type Object3D, Vector3 } from 'three';
import type { BoneMap, BoneName } from '../../core/humanoid/bones';
import type { SkeletonJoint } from '../../core/humanoid/joint-tree';
import { type HumanoidMatch, humanoidProblem, matchHumanoid } from '../../core/humanoid/match-humanoid';
import { type FileBones, fileBones, UnknownBonesError } from '../../core/humanoid/unknown-bones-error';
import { distance, isFiniteVec3 } from '../../core/math/vec3';
import { meshesOf, skinnedMeshesOf } from '../scene-meshes';
import { addHands } from './add-hands';
import { assertNeededBones } from './needed-bones';

/** Returns the name of a node in the file. three.js rewrites names and keeps the original in userData. */
const nameOf = (node: Object3D): string => (typeof node.userData.name === 'string' ? node.userData.name : node.name);

/** Returns the nodes by their names in the file; of several with one name the topmost. `among`: filters the nodes. */
function nodesByName(scene: Group, among: (node: Object3D) => boolean): Map<string, Object3D> {
  const nodes = new Map<string, Object3D>();
  scene.traverse((node) => {
    const name = nameOf(node);
    if (name !== '' && !nodes.has(name) && among(node)) nodes.set(name, node);
  });
  return nodes;
}

const skinBones = (scene: Group): Set<Object3D> =>
  new Set(skinnedMeshesOf(scene).flatMap(({ skeleton }) => skeleton.bones));

/**
 * Returns the nodes that may be bones: those that move skin and the nodes between them; all nodes if the file has no
 * skin. `known`: nodes that are bones in any case.
 */
function candidatesOf(scene: Group, known: Iterable<Object3D>): readonly Object3D[] {
  const skinned = skinBones(scene);
  if (skinned.size > 0) for (const node of known) skinned.add(node);
  const all: Object3D[] = [];
  scene.traverse((node) => all.push(node));
  if (skinned.size === 0) return all;
  const under = new Map<Object3D, number>();
  for (const bone of skinned)
    for (let node: Object3D | null = bone; node; node = node.parent) under.set(node, (under.get(node) ?? 0) + 1);
  // A node with all skin bones below it, except the lowest such node, is no part of the skeleton.
  const whole = all.filter((node) => under.get(node) === skinned.size);
  const root = skinned.has(whole.at(-1)!) ? whole.find((node) => skinned.has(node)) : whole.at(-1);
  const outside = new Set(root ? whole.slice(0, whole.indexOf(root)) : []);
  return all.filter((node) => under.has(node) && !outside.has(node));
}

/** Returns the sum of the skin weights of each bone; empty: no mesh has a skin. */
function skinWeights(scene: Group): Map<Object3D, number> {
  const sums = new Map<Object3D, number>();
  for (const { geometry, skeleton } of skinnedMeshesOf(scene)) {
    const { skinIndex, skinWeight } = geometry.attributes;
    if (!skinIndex || !skinWeight) continue;
    for (let vertex = 0; vertex < skinWeight.count; vertex++) {
      for (let i = 0; i < skinWeight.itemSize; i++) {
        const bone = skeleton.bones[skinIndex.getComponent(vertex, i)];
        if (bone) sums.set(bone, (sums.get(bone) ?? 0) + skinWeight.getComponent(vertex, i));
      }
    }
  }
  return sums;
}

const noSkeleton = 'it has no skeleton, only shapes; rig it first, for example in Blender or with Mixamo';

/**
 * Returns the bones of a scene at rest, and their nodes. Throws if joints have no finite positions, or all the same
 * one.
 */
export function skeletonOf(scene: Group, name: string, known: Iterable<Object3D> = []) {
  const nodes = candidatesOf(scene, known);
  const indices = new Map(nodes.map((node, i) => [node, i]));
  const weights = skinWeights(scene);
  // A scale below zero mirrors the joints; the skin is drawn mirrored, too.
  const mirror = nodes.some((node) => node.matrixWorld.determinant() < 0) ? -1 : 1;
  const place = new Vector3();
  const joints = nodes.map((node): SkeletonJoint => {
    const { x, y, z } = place.setFromMatrixPosition(node.matrixWorld);
    const position = { x: mirror * x, y, z };
    const parent = indices.get(node.parent as Object3D) ?? -1;
    return { name: nameOf(node), parent, position, ...(weights.size > 0 && { weight: weights.get(node) ?? 0 }) };
  });
  const lost = joints.find(({ position }) => !isFiniteVec3(position));
  if (lost) throw new Error(`${name}: the joint of ${lost.name} lies nowhere`);
  const isSkinned = weights.size > 0;
  if (joints.every(({ position }) => distance(position, joints[0]!.position) === 0)) {
    const reason = isSkinned ? 'its joints lie all in one place: is the scene scaled to nothing?' : noSkeleton;
    throw new Error(`${name}: ${reason}`);
  }
  return { nodes, joints, isSkinned };
}

/** The bones of a scene that is no VRM. */
export interface SceneBones {
  /** The bones as the file has them. */
  readonly file: FileBones;
  /** The nodes of the bones, with joints that were made. */
  readonly bones: Bones;
  /** The reason why they are no humanoid; null: they are one. */
  readonly problem: string | null;
  readonly notes: readonly string[];
}

type Bones = ReadonlyMap<BoneName, Object3D>;

interface Humanoid extends Pick<SceneBones, 'notes'> {
  readonly vrm: VRM;
}

const nodesOf = ({ map }: HumanoidMatch, nodes: readonly Object3D[]): Bones =>
  new Map(Object.entries(map).map(([bone, { joint }]) => [bone as BoneName, nodes[joint]!]));

const madeNotes = (made: Bones): readonly string[] =>
  [...made.values()].map(({ parent }) => `no hand follows ${nameOf(parent!)}: a joint was made where that arm ends`);

/** Matches the bones of a scene to a humanoid, and adds hands where its arms end at the forearm. */
export function matchScene(scene: Group, name: string): SceneBones {
  const own = skeletonOf(scene, name);
  const found = matchHumanoid(own.joints);
  const made = addHands(scene, nodesOf(found, own.nodes));
  const { nodes, joints } = made.size > 0 ? skeletonOf(scene, name, made.values()) : own;
  const match = made.size > 0 ? matchHumanoid(joints) : found;
  const problem = humanoidProblem(match);
  if (problem && !own.isSkinned && Object.keys(match.map).length === 0) throw new Error(`${name}: ${noSkeleton}`);
  const notes = [...match.notes, ...madeNotes(made)];
  return { file: fileBones(own.joints, found.map), bones: nodesOf(match, nodes), problem, notes };
}

/**
 * Returns the bones of a scene as a humanoid's. Throws an UnknownBonesError with the matched and the missing bones if
 * they are none.
 */
function foundBones(scene: Group, name: string): Pick<SceneBones, 'bones' | 'notes'> {
  const { file, bones, problem, notes } = matchScene(scene, name);
  if (!problem) return { bones, notes };
  const advice = "Map them by hand: loadAvatar(source, {bones: {hips: '…', …}})";
  throw new UnknownBonesError(`${name}: ${problem}. ${advice}`, file);
}

/** Returns the nodes that a map names; of several with one name, one that moves skin. Throws if a node is missing. */
function mappedNodes(scene: Group, bones: BoneMap, name: string): Bones {
  const skinned = skinBones(scene);
  // A mesh may have the name of the bone that moves it.
  const nodes = nodesByName(scene, (node) => skinned.has(node));
  for (const [called, node] of nodesByName(scene, () => true)) if (!nodes.has(called)) nodes.set(called, node);
  // The names that three.js has rewritten are accepted too, because pages print them.
  scene.traverse((node) => {
    if (!nodes.has(node.name)) nodes.set(node.name, node);
  });
  return new Map(
    Object.entries(bones).map(([bone, called]) => {
      const node = nodes.get(called);
      if (!node) throw new Error(`${name}: bones.${bone}: no node is called “${called}”`);
      return [bone as BoneName, node];
    }),
  );
}

/** Returns the bones that a map names, with hands where it names forearms alone. */
function mappedBones(scene: Group, map: BoneMap, name: string): Pick<SceneBones, 'bones' | 'notes'> {
  const named = mappedNodes(scene, map, name);
  const made = addHands(scene, named);
  return { bones: new Map([...named, ...made]), notes: madeNotes(made) };
}

/**
 * Creates a VRM from a scene that is none. Its bones are those of `given`, or matched ones; the notes are sentences on
 * what was assumed. Throws an Error that names the file and the missing bone.
 */
export function createHumanoid(scene: Group, name: string, given?: BoneMap): Humanoid {
  scene.updateMatrixWorld(true);
  const { bones, notes } = given ? mappedBones(scene, given, name) : foundBones(scene, name);
  assertNeededBones(name, (bone) => bones.has(bone));
  const humanBones = Object.fromEntries([...bones].map(([bone, node]) => [bone, { node }])) as unknown as VRMHumanBones;
  const humanoid = new VRMHumanoid(humanBones);
  scene.add(humanoid.normalizedHumanBonesRoot);
  const meshes = meshesOf(scene).map((mesh) => ({ meshes: [mesh], type: 'auto' }));
  const meta = { metaVersion: '1', name, authors: [], licenseUrl: '' } as unknown as VRM['meta'];
  const vrm = new VRM({ scene, meta, humanoid, firstPerson: new VRMFirstPerson(humanoid, meshes as never) });
  return { vrm, notes };
}
