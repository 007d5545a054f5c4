import type { BoneMap, BoneName } from './bones';
import type { SkeletonJoint } from './joint-tree';
import type { HumanoidMatch } from './match-humanoid';

/** The bones of a file, at rest or as they can be drawn; of a file without skins, all its nodes. */
export interface FileBones {
  readonly joints: readonly SkeletonJoint[];
  /** The matched bones: the name of the file's node for each. */
  readonly matched: BoneMap;
  /** The confidence of each match, 0 to 1. */
  readonly confidence: Readonly<Partial<Record<BoneName, number>>>;
}

/** Returns the bones of a file by their names. */
export function fileBones(joints: readonly SkeletonJoint[], map: HumanoidMatch['map']): FileBones {
  const matches = Object.entries(map);
  return {
    joints,
    matched: Object.fromEntries(matches.map(([bone, { joint }]) => [bone, joints[joint]!.name])),
    confidence: Object.fromEntries(matches.map(([bone, { confidence }]) => [bone, confidence])),
  };
}

/** The error of a file whose bones do not match a humanoid with all needed bones. A bone map can be supplied. */
export class UnknownBonesError extends Error implements FileBones {
  readonly joints: FileBones['joints'];
  readonly matched: FileBones['matched'];
  readonly confidence: FileBones['confidence'];

  constructor(message: string, { joints, matched, confidence }: FileBones) {
    super(message);
    this.joints = joints;
    this.matched = matched;
    this.confidence = confidence;
  }
}
