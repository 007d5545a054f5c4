import type { VRM } from '@pixiv/three-vrm';
import { type Object3D, Quaternion, Vector3 } from 'three';
import type { BoneName } from '../core/humanoid/bones';
import { addClip, type GltfDescription, type NodeTrack, packGlb } from '../core/motion/gltf';
import { createSkeletonPose, type SkeletonPose } from '../core/motion/imported-motion';
import { type Motion, poseBones } from '../core/motion/motion';
import { clipOf } from '../core/motion/write-vrma';
import { convertToGlb } from './file/convert-to-glb';
import { readGlbChunks } from './file/glb-chunks';
import { inspectAvatar } from './file/inspect-avatar';
import { boneNode } from './humanoid/needed-bones';
import { type Decoders, type LoadedAvatar, type ParseOptions, parseAvatar } from './load-avatar';

interface FileNode {
  matrix?: number[];
  translation?: number[];
  rotation?: number[];
  scale?: number[];
}

type AvatarDescription = GltfDescription & {
  nodes: FileNode[];
  meshes?: { primitives: { material?: number }[] }[];
  extensions?: Record<string, Record<string, unknown> | undefined>;
};

/** Writes a motion as an animated GLB file of an avatar. */
interface AvatarMotionWriter {
  readonly extension: 'glb';
  readonly type: 'model/gltf-binary';
  write(motion: Motion): Generator<number, readonly Uint8Array<ArrayBuffer>[]>;
}

const read = (bytes: ArrayBuffer, name: string, decoders: Decoders = {}) => {
  inspectAvatar(new Uint8Array(bytes), name, Object.keys(decoders));
  const chunks = readGlbChunks(new Uint8Array(bytes));
  if (!chunks) throw new Error(`${name}: not a VRM or GLB file (wrong signature, or truncated)`);
  return { description: JSON.parse(chunks.json) as AvatarDescription, binary: chunks.binary };
};

const whole = (parts: readonly Uint8Array<ArrayBuffer>[]): Promise<ArrayBuffer> => new Blob([...parts]).arrayBuffer();

/** The part of a VRM's extension that maps its bones. */
const humanoidParts = ['specVersion', 'exporterVersion', 'meta', 'humanoid', 'firstPerson'];

/** Returns the description without materials and images, which only a browser can decode. */
function bonesAlone(description: AvatarDescription): AvatarDescription {
  const bare = structuredClone(description);
  for (const field of ['images', 'textures', 'samplers', 'materials']) delete bare[field];
  for (const { primitives } of bare.meshes ?? []) for (const primitive of primitives) delete primitive.material;
  const extensions: AvatarDescription['extensions'] = {};
  for (const name of ['VRM', 'VRMC_vrm']) {
    const own = bare.extensions?.[name];
    if (!own) continue;
    const kept = Object.fromEntries(Object.entries(own).filter(([part]) => humanoidParts.includes(part)));
    const { thumbnailImage: _, texture: __, ...meta } = (kept.meta ?? {}) as Record<string, unknown>;
    extensions[name] = { ...kept, meta };
  }
  bare.extensions = extensions;
  return bare;
}

/** A bone of the rig and the bone of the motion that drives it. */
interface DrivenBone {
  /** The index among the motion's bones of the nearest ancestor that the rig has; −1: there is none. */
  readonly bone: number;
  readonly above: number;
  readonly node: number;
  /** The node's rotation is before · (the bone's rotation relative to its ancestor) · after. */
  readonly before: Quaternion;
  readonly after: Quaternion;
}

function drivenBones(motion: Motion, { vrm, nodeIndices }: LoadedAvatar): readonly DrivenBone[] {
  const nodes = motion.bones.map(({ name, measured }) => (measured ? boneNode(vrm, name as BoneName) : null));
  const rest = (object: Object3D | null) => object?.getWorldQuaternion(new Quaternion()) ?? new Quaternion();
  return nodes.flatMap((object, bone): DrivenBone[] => {
    const node = object && nodeIndices.get(object);
    if (!object || node == null) return [];
    let above = -1;
    for (let up = object.parent; up && above < 0; up = up.parent) above = nodes.indexOf(up);
    return [{ bone, above, node, before: rest(object.parent).invert(), after: rest(object) }];
  });
}

const turned = new Quaternion();
const carried = new Quaternion();

/** Returns the rotation of a driven node in a frame, in the axes of the file. */
function nodeRotation({ bone, above, before, after }: DrivenBone, { rotations }: SkeletonPose): Quaternion {
  const { x, y, z, w } = rotations[bone]!;
  turned.set(x, y, z, w);
  if (above >= 0) {
    const q = rotations[above]!;
    turned.premultiply(carried.copy(q).invert());
  }
  return turned.premultiply(before).multiply(after);
}

/** Writes the rest pose into the nodes: loading brings avatars in other poses into T-pose. */
function writeRest(description: AvatarDescription, nodeIndices: LoadedAvatar['nodeIndices']): void {
  for (const [{ position, quaternion, scale }, index] of nodeIndices) {
    const node = description.nodes[index];
    if (!node) continue;
    delete node.matrix;
    node.translation = position.toArray();
    node.rotation = quaternion.normalize().toArray();
    node.scale = scale.toArray();
  }
}

/**
 * Returns a function that transforms the position of the hips [m] into the frame of their node's parent, scaled to the
 * rig's height.
 */
function hipsPlacer(vrm: VRM, motion: Motion): (x: number, y: number, z: number) => Vector3 {
  const hips = boneNode(vrm, 'hips')!;
  const stature = hips.getWorldPosition(new Vector3()).y / motion.bones[0]!.offset.y;
  const inParent = hips.parent!.matrixWorld.clone().invert();
  const place = new Vector3();
  return (x, y, z) => place.set(x, y, z).multiplyScalar(stature).applyMatrix4(inParent);
}

/** Returns the animation: rotations are those of the motion, positions are scaled to the avatar's legs. */
function* clipTracks(motion: Motion, avatar: LoadedAvatar): Generator<number, readonly NodeTrack[]> {
  const driven = drivenBones(motion, avatar);
  const count = motion.times.length;
  const rotations = driven.map(() => new Float32Array(4 * count));
  const hips = new Float32Array(3 * count);
  const place = hipsPlacer(avatar.vrm, motion);
  const posed = createSkeletonPose(motion.bones.length);
  for (let frame = 0; frame < count; frame++) {
    poseBones(motion, frame, posed);
    const { x, y, z } = posed.positions[0]!;
    place(x, y, z).toArray(hips, 3 * frame);
    for (const [i, bone] of driven.entries())
      nodeRotation(bone, posed)
        .normalize()
        .toArray(rotations[i]!, 4 * frame);
    if (frame % 64 === 63) yield frame / count;
  }
  const node = driven.find(({ bone }) => bone === 0)!.node;
  return [
    { node, path: 'translation', values: hips },
    ...driven.map(({ node }, i) => ({ node, path: 'rotation' as const, values: rotations[i]! })),
  ];
}

/**
 * Returns a writer of animated GLB files of an avatar: VRM, or another humanoid. The output keeps everything in the
 * avatar's file except its animations; FBX is converted first. Rejects with an Error that names the file.
 */
export async function createAvatarMotionWriter(
  given: ArrayBuffer,
  name: string,
  options: ParseOptions = {},
): Promise<AvatarMotionWriter> {
  const bytes = await convertToGlb(given, name, 'body');
  const { description, binary } = read(bytes, name, options.decoders);
  const bare = await whole(packGlb(bonesAlone(description), [new Uint8Array(binary)]));
  const avatar = await parseAvatar(bare, name, options);
  avatar.vrm.scene.updateMatrixWorld(true);
  return {
    extension: 'glb',
    type: 'model/gltf-binary',
    *write(motion) {
      const moved = structuredClone(description);
      writeRest(moved, avatar.nodeIndices);
      const tracks = yield* clipTracks(motion, avatar);
      const more = addClip(moved, binary.length, { ...clipOf(motion), tracks });
      return packGlb(moved, [new Uint8Array(binary), more]);
    },
  };
}
