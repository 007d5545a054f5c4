import type { BoneMap } from './bone-names';

/** A file with bones whose names tell no body, or not all that a body needs: a map of them can be given. */
export class UnknownBones extends Error {
  /** What the file calls its bones; of those that carry no skin, all its nodes. */
  readonly found: readonly string[];
  /** What the names tell all the same. */
  readonly told: BoneMap;

  constructor(message: string, found: readonly string[], told: BoneMap = {}) {
    super(message);
    this.found = found;
    this.told = told;
  }
}
