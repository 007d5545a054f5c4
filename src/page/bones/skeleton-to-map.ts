import type { BoneMap } from 'threepoint/core/humanoid/bones';
import type { FileBones } from 'threepoint/core/humanoid/unknown-bones-error';

/**
 * The skeleton of a file, of an avatar or a motion, whose bones the user maps: they could not be matched to a humanoid,
 * or are to be corrected.
 */
export interface SkeletonToMap extends Pick<FileBones, 'joints' | 'confidence'> {
  /** The name of the file. */
  readonly name: string;
  /** The bones that are known, or that the user gave last. */
  readonly bones: BoneMap;
  /** A sentence about what is wrong with them; null: the user gave none yet. */
  readonly complaint: string | null;
  /** Whether the file is shown already. */
  readonly isShown: boolean;
  /** Whether the bones are the user's map, which can be forgotten. */
  readonly canForgetMap: boolean;
}
