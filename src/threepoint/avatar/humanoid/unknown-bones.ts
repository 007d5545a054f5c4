import type { BoneMap, BoneName } from '../../core/humanoid/bones';
import type { SkeletonJoint } from '../../core/humanoid/joint-tree';
import type { HumanoidMatch } from '../../core/humanoid/match-humanoid';

/** The error of a file whose bones match no humanoid, or not all needed bones: a map of them can be given. */
export class UnknownBones extends Error {
  /** The bones that were matched, by what the file calls them. */
  readonly matched: BoneMap;
  /** How sure each match is, from 0 to 1. */
  readonly confidence: Readonly<Partial<Record<BoneName, number>>>;

  /** `joints`: the file's bones at rest; of a file without skins, all its nodes. */
  constructor(
    message: string,
    readonly joints: readonly SkeletonJoint[],
    map: HumanoidMatch['map'],
  ) {
    super(message);
    const matches = Object.entries(map);
    this.matched = Object.fromEntries(matches.map(([bone, { joint }]) => [bone, joints[joint]!.name]));
    this.confidence = Object.fromEntries(matches.map(([bone, { confidence }]) => [bone, confidence]));
  }
}
