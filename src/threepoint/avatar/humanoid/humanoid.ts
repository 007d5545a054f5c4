import { VRM, VRMFirstPerson, type VRMHumanBones, VRMHumanoid } from '@pixiv/three-vrm';
import type { Group, Object3D, SkinnedMesh } from 'three';
import { reasonOf } from '../../core/errors/reasons';
import { type BoneMap, bonesByName, knownNamings } from './bone-names';
import { UnknownBones } from './unknown-bones';

/** Bones without which there is no upper body to move. */
export const neededBones = [
  'hips',
  'spine',
  'head',
  'leftUpperArm',
  'leftLowerArm',
  'leftHand',
  'rightUpperArm',
  'rightLowerArm',
  'rightHand',
] as const;

/** Names that a sentence shows of those that a file has. */
const shownNames = 12;

/** The file's own name of a node: three.js rewrites names, and keeps the file's beside. */
const nameOf = (node: Object3D): string => (typeof node.userData.name === 'string' ? node.userData.name : node.name);

/** Nodes by the file's own names; of several of one name the uppermost. `among`: which nodes count. */
function nodesByName(scene: Group, among: (node: Object3D) => boolean): Map<string, Object3D> {
  const nodes = new Map<string, Object3D>();
  scene.traverse((node) => {
    const name = nameOf(node);
    if (name !== '' && !nodes.has(name) && among(node)) nodes.set(name, node);
  });
  return nodes;
}

function skinBones(scene: Group): Set<Object3D> {
  const bones = new Set<Object3D>();
  scene.traverse((node) => {
    if ('isSkinnedMesh' in node) for (const bone of (node as SkinnedMesh).skeleton.bones) bones.add(bone);
  });
  return bones;
}

const lacks = (bones: BoneMap): string[] => neededBones.filter((bone) => bones[bone] === undefined);

/**
 * Returns the bones that are known by their names. Throws a sentence with the names that were found where they match no
 * humanoid.
 */
function knownBones(scene: Group, name: string): { readonly bones: BoneMap; readonly nodes: Map<string, Object3D> } {
  const skinned = skinBones(scene);
  const joints = nodesByName(scene, (node) => skinned.has(node));
  const all = nodesByName(scene, () => true);
  const named = (nodes: Map<string, Object3D>) => ({ nodes, bones: bonesByName([...nodes.keys()]) });
  const byJoints = named(joints);
  const byAll = named(all);
  const choice = lacks(byJoints.bones).length <= lacks(byAll.bones).length ? byJoints : byAll;
  if (choice.bones.hips !== undefined) return choice;
  const found = [...(joints.size > 0 ? joints : all).keys()];
  if (found.length === 0) throw new Error(`${name}: no humanoid in the file: it has no bones`);
  const shownFound =
    found.slice(0, shownNames).join(', ') + (found.length > shownNames ? ` and ${found.length - shownNames} more` : '');
  throw new UnknownBones(
    `${name}: its bones could not be matched to a humanoid (found: ${shownFound}; known: ${knownNamings.join('; ')}). Map them by hand: loadAvatar(source, {bones: {hips: '…', …}})`,
    found,
  );
}

/** The nodes that a map names, of several of one name one that carries skin. Throws where one is not in the file. */
function mappedBones(scene: Group, bones: BoneMap, name: string): Map<string, Object3D> {
  const skinned = skinBones(scene);
  // A mesh may be called as the bone that moves it.
  const nodes = nodesByName(scene, (node) => skinned.has(node));
  for (const [called, node] of nodesByName(scene, () => true)) if (!nodes.has(called)) nodes.set(called, node);
  // What three.js made of a name counts as well: it is what pages print.
  scene.traverse((node) => {
    if (!nodes.has(node.name)) nodes.set(node.name, node);
  });
  for (const [bone, called] of Object.entries(bones)) {
    if (!nodes.has(called)) throw new Error(`${name}: bones.${bone}: no node is called “${called}”`);
  }
  return nodes;
}

/**
 * Makes a VRM of a scene that is none. Its bones are those of `bones`, or those that are known by their nodes' names.
 * Throws a sentence that names the file and the missing bone, or the names that were found.
 */
export function humanoidOf(scene: Group, name: string, given?: BoneMap): VRM {
  const { bones, nodes } = given ? { bones: given, nodes: mappedBones(scene, given, name) } : knownBones(scene, name);
  try {
    demandBones(name, (bone) => bones[bone] !== undefined);
  } catch (error) {
    throw given ? error : new UnknownBones(reasonOf(error), [...nodes.keys()], bones);
  }
  const humanBones = Object.fromEntries(
    Object.entries(bones).map(([bone, called]) => [bone, { node: nodes.get(called) }]),
  ) as unknown as VRMHumanBones;
  const humanoid = new VRMHumanoid(humanBones);
  scene.add(humanoid.normalizedHumanBonesRoot);
  const meshes: { meshes: Object3D[]; type: 'auto' }[] = [];
  scene.traverse((node) => {
    if ('isMesh' in node) meshes.push({ meshes: [node], type: 'auto' });
  });
  const meta = { metaVersion: '1', name, authors: [], licenseUrl: '' } as unknown as VRM['meta'];
  return new VRM({ scene, meta, humanoid, firstPerson: new VRMFirstPerson(humanoid, meshes as never) });
}

/** Throws a sentence that names the file and the bones that a body needs and this one lacks. */
export function demandBones(name: string, has: (bone: (typeof neededBones)[number]) => boolean): void {
  const missing = neededBones.filter((bone) => !has(bone));
  if (missing.length > 0) throw new Error(`${name}: its humanoid has no ${missing.join(', ')}`);
}

/** The node of a bone as the file has it. */
export const boneNode = (vrm: VRM, bone: keyof BoneMap): Object3D | null =>
  vrm.humanoid.getRawBoneNode(bone as Parameters<VRM['humanoid']['getRawBoneNode']>[0]);
