import type { BoneMap } from '../../core/humanoid/bones';

/** The error of a file whose bone names match no humanoid, or not all needed bones: a map of them can be given. */
export class UnknownBones extends Error {
  /** What the file calls its bones; of those that carry no skin, all its nodes. */
  readonly found: readonly string[];
  /** The bones that were matched by their names. */
  readonly matched: BoneMap;

  constructor(message: string, found: readonly string[], told: BoneMap = {}) {
    super(message);
    this.found = found;
    this.matched = told;
  }
}
