import { VRMUtils } from '@pixiv/three-vrm';
import type { BoneName } from '../../core/humanoid/bones';
import type { BoneMatch } from '../../core/humanoid/match-humanoid';
import { type FileBones, fileBones } from '../../core/humanoid/unknown-bones-error';
import type { CheckedAvatar } from '../file/check-avatar';
import { type Decoders, readScene } from '../load-avatar';
import { matchScene, skeletonOf } from './create-humanoid';

/** The bones of a file, and whether it can be used without a bone map. */
export interface ReadBones extends FileBones {
  readonly accepted: boolean;
}

/**
 * Reads the bones of a checked file and matches them: by a VRM's humanoid, else by the matcher. Rejects with an Error
 * that names the file.
 */
export async function readFileBones(checked: CheckedAvatar, decoders: Decoders): Promise<ReadBones> {
  const { gltf, own } = await readScene(checked, { decoders });
  const { scene } = gltf;
  try {
    // three-vrm adds joints that the file does not have.
    own?.humanoid.normalizedHumanBonesRoot.removeFromParent();
    scene.updateMatrixWorld(true);
    if (!own) {
      const { file, problem } = matchScene(scene, checked.name);
      return { ...file, accepted: problem === null };
    }
    const stated = Object.entries(own.humanoid.humanBones).map(([bone, { node }]) => ({ bone, node }));
    const { nodes, joints } = skeletonOf(
      scene,
      checked.name,
      stated.map(({ node }) => node),
    );
    const matches = stated.map(({ bone, node }): readonly [BoneName, BoneMatch] => [
      bone as BoneName,
      { joint: nodes.indexOf(node), confidence: 1, reason: 'the file states it' },
    ]);
    return { ...fileBones(joints, Object.fromEntries(matches)), accepted: true };
  } finally {
    VRMUtils.deepDispose(scene);
  }
}
